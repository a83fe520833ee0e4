#include "proto/text.h"

#include <array>
#include <charconv>
#include <cmath>

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

std::string shorten(std::string_view text) {
  constexpr size_t longest = 80;
  std::string out;
  for (char c : text.substr(0, longest)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > longest ? out + "..." : out;
}

void append_item(std::string& list, std::string_view separator, std::string_view item) {
  if (!list.empty()) list += separator;
  list += item;
}

std::string quote(std::string_view text) { return '"' + shorten(text) + '"'; }

}  // namespace papilio::proto
