#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "papilio/vec3.h"

namespace papilio::client {

/// Returns the number in the first bytes of `bytes`, in the given byte order. There must be enough bytes.
template <class Number>
Number load(std::string_view bytes, std::endian order) {
  std::array<char, sizeof(Number)> raw;
  std::copy_n(bytes.begin(), raw.size(), raw.begin());
  if (order != std::endian::native) std::ranges::reverse(raw);
  return std::bit_cast<Number>(raw);
}

/// Appends a number in little-endian order.
template <class Number>
void store(std::string& bytes, Number number) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (std::endian::native != std::endian::little) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

inline void store_vector(std::string& bytes, Vec3f v) {
  for (const float coordinate : {v.x, v.y, v.z}) store(bytes, coordinate);
}

}  // namespace papilio::client
