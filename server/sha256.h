#pragma once

#include <string>
#include <string_view>

namespace papilio::server {

/// SHA-256 of the bytes as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);
/// Whether the text is of that form.
[[nodiscard]] bool is_sha256(std::string_view text);

}  // namespace papilio::server
