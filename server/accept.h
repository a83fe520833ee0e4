#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilio::server {

/// Content negotiation (RFC 9110, section 12.5.1): which of `offered` media types, in our order of
/// preference, the client's `Accept` likes best; nothing when it takes none. An empty `Accept` takes the
/// first.
[[nodiscard]] std::optional<std::string> negotiate(std::string_view accept, const std::vector<std::string>& offered);

}  // namespace papilio::server
