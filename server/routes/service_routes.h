#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// Answers GET /v1/info: version, limits, schemes, parameters, samples.
[[nodiscard]] Response info_route(Engine& engine, Request& request);
/// Answers GET /health. Takes no lock of the work, so that it always answers.
[[nodiscard]] Response health_route(Engine& engine, Request& request);
/// Answers GET /ready. Throws `Problem` not_ready while no further request would be admitted.
[[nodiscard]] Response ready_route(Engine& engine, Request& request);
/// Answers GET /metrics, for Prometheus.
[[nodiscard]] Response metrics_route(Engine& engine, Request& request);

/// Limit set by the operator, with the name of its setting, for /v1/info and OpenAPI.
struct NamedLimit {
  std::string_view name;
  uint64_t value;
  std::string_view description;
};
[[nodiscard]] std::vector<NamedLimit> named_limits(const EngineOptions& options);

}  // namespace papilio::server
