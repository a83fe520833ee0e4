#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace papilio::proto {

/// Parses a finite decimal number that is the whole text; returns nothing for other text. Independent of the locale.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Formats a number as the shortest text that parses to an equal number.
[[nodiscard]] std::string format_number(double value);

/// Formats a number with four significant digits.
[[nodiscard]] std::string format_rounded(double value);

/// Shortens user text for an error message to 80 bytes, with ? for other characters than printable ASCII.
[[nodiscard]] std::string shorten(std::string_view text);
/// Shortens user text and puts it in double quotes.
[[nodiscard]] std::string quote(std::string_view text);

/// Escapes untrusted text for a terminal or a log. Control characters, marks of text direction and bytes outside UTF-8
/// become escapes such as \x1b or \u202e. Other characters are kept.
[[nodiscard]] std::string escape_controls(std::string_view text);

/// Appends an item to a list, with a separator unless the list is empty.
void append_item(std::string& list, std::string_view separator, std::string_view item);

}  // namespace papilio::proto
