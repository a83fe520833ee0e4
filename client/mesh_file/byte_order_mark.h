#pragma once

#include <string_view>

namespace papilio::client {

/// A text's bytes without the byte order mark of UTF-8, which some editors put first. Throws `ParseError` for the mark
/// of UTF-16 or UTF-32, in which no mesh file is read.
[[nodiscard]] std::string_view skip_byte_order_mark(std::string_view text);

}  // namespace papilio::client
