#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "proto/problem.h"
#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// Body of a request to an endpoint.
enum class Input { none, mesh, mesh_or_form, parameters };
/// Body of an answer.
enum class Output { refined, mesh, description, info, health, metrics, openapi, page, asset, sample, nothing };

/// Row of the table of endpoints, which defines routes, access and the OpenAPI document.
struct Endpoint {
  std::string_view method;
  std::string_view path;  ///< path with `{id}` for a mesh's id, `{name}` for the name of a file or sample
  std::string_view name;  ///< operationId of OpenAPI
  std::string_view summary;
  Access access;
  WhileDraining while_draining;
  bool parameters;  ///< whether its query takes the parameters of a refinement
  Input input;
  Output output;
  std::vector<proto::Code> problems;  ///< problems besides common_problems()
  Response (*answer)(Engine&, Request&);
};

/// Returns all endpoints. HEAD follows GET, and OPTIONS is supported by all paths.
[[nodiscard]] std::span<const Endpoint> endpoints();
/// Returns the problems that any endpoint may answer with.
[[nodiscard]] std::span<const proto::Code> common_problems();

/// Adds every endpoint of the table. The engine must outlive the server.
void add_endpoints(HttpServer& server, Engine& engine);

}  // namespace papilio::server
