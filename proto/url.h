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

/// Joins fields to "a=1&b=2", with names and values percent-encoded.
[[nodiscard]] std::string join_query(const std::vector<std::pair<std::string, std::string>>& fields);

}  // namespace papilio::proto
