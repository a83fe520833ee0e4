#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilio::server {

/// Negotiates the content type (RFC 9110, section 12.5.1): returns the media type of highest quality in `Accept`, of
/// `offered` in the server's order of preference; nothing if none is acceptable. An empty `Accept` selects the first.
[[nodiscard]] std::optional<std::string> negotiate(std::string_view accept, const std::vector<std::string>& offered);

/// Returns whether `Accept-Encoding` accepts gzip (RFC 9110, section 12.5.3); false if it is empty.
[[nodiscard]] bool accepts_gzip(std::string_view accept_encoding);

}  // namespace papilio::server
