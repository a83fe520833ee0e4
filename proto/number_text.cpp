#include <array>
#include <charconv>
#include <cmath>

#include "proto/text.h"

// What client/wasm/number_text.cpp replaces in the browser, where the standard library lacks or bloats it.

namespace papilio::proto {

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string format_number(double value) {
  std::array<char, 32> text{};
  if (value == 0) value = 0;  // not "-0"
  const bool plain = std::abs(value) < 1e9 && value == std::floor(value);
  const auto [end, error] = plain
                                ? std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed)
                                : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), error == std::errc() ? end : text.data()};
}

}  // namespace papilio::proto
