#include "client/mesh_file/number_text.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace papilio::client {
namespace {

template <class Number>
std::errc parse_whole(std::string_view word, Number& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::errc::invalid_argument;
  return error;
}

}  // namespace

bool parse_number(std::string_view word, float& value) {
  const std::errc error = parse_whole(word, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  // from_chars does not distinguish too large from too small.
  double wide = 0;
  if (!parse_number(word, wide) || std::abs(wide) >= 1) return false;
  value = static_cast<float>(wide);
  return true;
}

bool parse_number(std::string_view word, double& value) {
  const std::errc error = parse_whole(word, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  long double wide = 0;
  if (parse_whole(word, wide) != std::errc() || std::abs(wide) >= 1) return false;
  value = static_cast<double>(wide);
  return true;
}

bool parse_number(std::string_view word, int64_t& value) { return parse_whole(word, value) == std::errc(); }

}  // namespace papilio::client
