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

/// Whether `Accept-Encoding` takes gzip (RFC 9110, section 12.5.3). An empty one is taken to mean: as it is.
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

}  // namespace papilio::server
