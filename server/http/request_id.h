#pragma once

#include <string>

namespace papilio::server {

/// The client's id when it is a sane one (1 to 64 of [A-Za-z0-9._-], safe in a header and in a log), else a
/// fresh random one.
[[nodiscard]] std::string request_id(const std::string& offered);

}  // namespace papilio::server
