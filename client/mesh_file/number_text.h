#pragma once

#include <cstdint>
#include <string_view>

namespace papilio::client {

/// Parses a whole word as a number, in any locale; a leading plus is accepted. Returns false if it is no number, or too
/// large for the type. A number too small for the type becomes the nearest one, 0 or subnormal.
[[nodiscard]] bool parse_number(std::string_view word, float& value);
[[nodiscard]] bool parse_number(std::string_view word, double& value);
[[nodiscard]] bool parse_number(std::string_view word, int64_t& value);

}  // namespace papilio::client
