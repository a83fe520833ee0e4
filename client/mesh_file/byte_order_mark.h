#pragma once

#include <string_view>

namespace papilio::client {

/// Returns a text without the byte order mark of UTF-8, which some editors write. Throws `ParseError` for the mark of
/// UTF-16 or UTF-32, which are unsupported.
[[nodiscard]] std::string_view skip_byte_order_mark(std::string_view text);

}  // namespace papilio::client
