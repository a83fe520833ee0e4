#include <array>
#include <cmath>

#include "proto/text.h"

// WebAssembly's standard library cannot parse doubles, and its formatting would take a third of the module's size. So
// the caller's language does both, with identical digits.

#define PAPILIO_IMPORTED(name) [[clang::import_module("papilio"), clang::import_name(#name)]]

extern "C" {
/// Parses a decimal number; returns NaN for other text.
PAPILIO_IMPORTED(parse_number) double caller_parse_number(const char* text, size_t length);
/// Writes the shortest exact text of the number, at most 32 bytes; returns its length.
PAPILIO_IMPORTED(format_number) size_t caller_format_number(double number, char* text);
}

namespace papilio::proto {

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text[0] == '+' || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos)
    return std::nullopt;
  const double value = caller_parse_number(text.data(), text.size());
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::string format_number(double value) {
  std::array<char, 32> text{};
  const size_t length = caller_format_number(value == 0 ? 0 : value, text.data());  // not "-0"
  return {text.data(), length};
}

}  // namespace papilio::proto
