#pragma once

#include <string>

namespace papilio::server {

/// Returns the client's id if it is valid (1 to 64 of [A-Za-z0-9._-], safe in a header and in a log), else a random
/// one.
[[nodiscard]] std::string request_id(const std::string& offered);

}  // namespace papilio::server
