#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace papilio::proto {

/// Percent-encodes all but the unreserved characters of RFC 3986 and the comma, which lists use.
[[nodiscard]] std::string encode_url(std::string_view text);

/// "a=1&b=2", names and values percent-encoded.
[[nodiscard]] std::string join_query(const std::vector<std::pair<std::string, std::string>>& fields);

}  // namespace papilio::proto
