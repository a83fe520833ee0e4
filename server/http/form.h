#pragma once

#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// Returns the parts of a `multipart/form-data` body (RFC 7578), in order. Linear in the body. Throws `Problem`
/// bad_request if the boundary is missing or invalid, a part has no name, the closing boundary is missing, or there are
/// more than 64 parts. cpp-httplib's parser is not used: it requires `name` first and nothing after the boundary, and
/// uses std::regex.
[[nodiscard]] std::vector<FormPart> parse_form(std::string_view content_type, std::string_view body);

}  // namespace papilio::server
