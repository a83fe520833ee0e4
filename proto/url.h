#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace papilio::proto {

/// Percent-encodes all but the unreserved characters of RFC 3986 and the comma, which lists use.
[[nodiscard]] std::string encode_url(std::string_view text);
/// Decodes percent-encoded text; nothing for a % without two hexadecimal digits. `plus_is_space`: decodes + as a space,
/// as in a query.
[[nodiscard]] std::optional<std::string> decode_url(std::string_view text, bool plus_is_space = false);

/// Decodes like `decode_url`. Throws `Problem` bad_request for a % without two hexadecimal digits.
[[nodiscard]] std::string require_decoded(std::string_view text, bool plus_is_space = false);

/// Splits "a=1&b=2" and decodes names and values, in order. Throws `Problem` bad_request.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> split_query(std::string_view query);
/// Joins fields to "a=1&b=2", with names and values percent-encoded.
[[nodiscard]] std::string join_query(const std::vector<std::pair<std::string, std::string>>& fields);

}  // namespace papilio::proto
