#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace papilio::proto {

/// A finite decimal number that fills the whole text; nothing for anything else. Independent of the locale.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string format_number(double value);

/// The number to four significant digits.
[[nodiscard]] std::string format_rounded(double value);

/// User text for an error message: cut to 80 bytes, without control characters or broken UTF-8.
[[nodiscard]] std::string shorten(std::string_view text);
/// The same in double quotes.
[[nodiscard]] std::string quote(std::string_view text);

/// Text of others for a terminal or a log: a control character, a mark that reverses the direction of text, and a byte
/// that is no UTF-8 become escapes such as \x1b or \u202e. All other characters stay.
[[nodiscard]] std::string escape_controls(std::string_view text);

/// Appends an item to a list, after the separator unless it is the first.
void append_item(std::string& list, std::string_view separator, std::string_view item);

}  // namespace papilio::proto
