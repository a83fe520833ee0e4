#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace papilio::fuzz {

/// Reads values from the front of an input; zeros at its end, so that every input is valid.
class ByteSource {
 public:
  ByteSource(const uint8_t* data, size_t size) : bytes_(data, size) {}

  [[nodiscard]] size_t left() const { return bytes_.size(); }

  template <class Number>
  Number raw() {
    Number number{};
    const size_t size = std::min(sizeof number, bytes_.size());
    if (size > 0) std::memcpy(&number, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return number;
  }

  bool flag() { return (raw<uint8_t>() & 1U) != 0; }
  /// Returns a number in 0..`most`.
  uint32_t up_to(uint32_t most);
  /// Returns a number between the two, often one of the bounds.
  double between(double low, double high);
  /// Returns any number: a small integer, a fraction, or arbitrary bits.
  float coordinate();
  std::string_view rest();

 private:
  std::span<const uint8_t> bytes_;
};

}  // namespace papilio::fuzz
