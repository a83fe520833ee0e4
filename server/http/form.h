#pragma once

#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// The parts of a `multipart/form-data` body (RFC 7578), in order. Throws bad_request when the boundary is
/// missing or unlawful, a part has no name, the closing boundary is missing, or there are more than 64 parts.
/// Linear in the body. cpp-httplib's parser is not used: it wants `name` first, nothing after the boundary,
/// and matches with std::regex.
[[nodiscard]] std::vector<FormPart> parse_form(std::string_view content_type, std::string_view body);

}  // namespace papilio::server
