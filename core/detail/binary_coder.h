#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Arithmetic coding of bits with 16-bit probabilities [Witten, Neal, Cleary 1987; the carry-free form with 32-bit
// bounds]. Integers only: bytes are identical on every processor.

namespace papilio {

/// Bits of a probability, which is in 1..65535, of 65536.
inline constexpr uint32_t probability_bits = 16;

class BinaryEncoder {
 public:
  /// Codes a bit, and returns it.
  bool code(bool bit, uint32_t probability_of_one) {
    const uint32_t range = high_ - low_;
    const uint32_t middle = low_ + static_cast<uint32_t>((uint64_t{range} * probability_of_one) >> probability_bits);
    (bit ? high_ : low_) = bit ? middle : middle + 1;
    while (((low_ ^ high_) >> 24) == 0) {
      bytes_.push_back(static_cast<uint8_t>(high_ >> 24));
      low_ <<= 8;
      high_ = (high_ << 8) | 0xFF;
    }
    return bit;
  }

  /// Returns the bytes of all bits. Drops trailing zeros: the decoder reads zeros behind the end.
  [[nodiscard]] std::vector<uint8_t> finish() {
    // Finds the shortest number within the bounds.
    for (uint32_t count = 0; count <= 4; ++count) {
      const uint32_t mask = count == 0 ? 0xFFFFFFFFU : count == 4 ? 0 : 0xFFFFFFFFU >> (8 * count);
      const uint64_t up = (uint64_t{low_} + mask) & ~uint64_t{mask};
      if (up > high_) continue;
      for (uint32_t i = 0; i < count; ++i) bytes_.push_back(static_cast<uint8_t>(up >> (24 - 8 * i)));
      break;
    }
    while (!bytes_.empty() && bytes_.back() == 0) bytes_.pop_back();
    return std::move(bytes_);
  }

 private:
  uint32_t low_ = 0, high_ = 0xFFFFFFFF;
  std::vector<uint8_t> bytes_;
};

class BinaryDecoder {
 public:
  explicit BinaryDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | next();
  }

  [[nodiscard]] bool code(uint32_t probability_of_one) {
    const uint32_t range = high_ - low_;
    const uint32_t middle = low_ + static_cast<uint32_t>((uint64_t{range} * probability_of_one) >> probability_bits);
    const bool bit = code_ <= middle;
    (bit ? high_ : low_) = bit ? middle : middle + 1;
    while (((low_ ^ high_) >> 24) == 0) {
      low_ <<= 8;
      high_ = (high_ << 8) | 0xFF;
      code_ = (code_ << 8) | next();
    }
    return bit;
  }

 private:
  [[nodiscard]] uint32_t next() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }

  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  uint32_t low_ = 0, high_ = 0xFFFFFFFF, code_ = 0;
};

}  // namespace papilio
