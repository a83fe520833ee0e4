#pragma once

#include <string>

#include "server/http/http.h"

namespace papilio::server {

/// Sends spdlog's default logger to standard error, at this level ("debug", "info", "warning", "error",
/// "off").
void start_log(const std::string& level);

/// One structured line a request, key=value: id, method, path, status, milliseconds, bytes in and out, remote
/// address, and what went wrong. Successful health questions are logged at debug level only.
void log_request(const Finished& request);

}  // namespace papilio::server
