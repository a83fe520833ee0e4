#pragma once

#include <string>

#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// Returns the OpenAPI 3.1 document of the service, made from the tables of endpoints, parameters, problems and limits.
[[nodiscard]] std::string openapi_json(const EngineOptions& options);
/// Answers GET /openapi.json.
[[nodiscard]] Response openapi_route(Engine& engine, Request& request);

}  // namespace papilio::server
