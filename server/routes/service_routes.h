#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// GET /v1/info: version, limits, schemes, parameters, samples.
[[nodiscard]] Response info_route(Engine& engine, Request& request);
/// GET /health: touches no lock of the work, so it answers whatever is going on.
[[nodiscard]] Response health_route(Engine& engine, Request& request);
/// GET /ready: throws `Problem` not_ready while no further request would be let in.
[[nodiscard]] Response ready_route(Engine& engine, Request& request);
/// GET /metrics: for Prometheus.
[[nodiscard]] Response metrics_route(Engine& engine, Request& request);

/// What the operator has set, by the names of its settings: {"max_body_bytes": ..., ...}. For /v1/info and OpenAPI.
struct NamedLimit {
  std::string_view name;
  uint64_t value;
  std::string_view description;
};
[[nodiscard]] std::vector<NamedLimit> named_limits(const EngineOptions& options);

}  // namespace papilio::server
