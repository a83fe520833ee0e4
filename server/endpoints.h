#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "proto/problem.h"
#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// What a request to an endpoint carries.
enum class Input { none, mesh, mesh_or_form, parameters };
/// What it is answered.
enum class Output { refined, mesh, description, info, health, metrics, openapi, page, asset, sample, nothing };

/// One row of the table of endpoints: routes, access and the OpenAPI document are made from it.
struct Endpoint {
  std::string_view method;
  std::string_view path;  ///< with `{id}` for a mesh's id, `{name}` for a file's or a sample's name
  std::string_view name;  ///< OpenAPI's operationId
  std::string_view summary;
  Access access;
  WhileDraining while_draining;
  bool parameters;  ///< takes the parameters of a refinement in its query
  Input input;
  Output output;
  std::vector<proto::Code> problems;  ///< besides those that any request can end in
  Response (*answer)(Engine&, Request&);
};

/// All of them. HEAD follows GET, and OPTIONS answers everywhere.
[[nodiscard]] std::span<const Endpoint> endpoints();
/// The refusals that any endpoint may answer with.
[[nodiscard]] std::span<const proto::Code> common_problems();

/// Adds every endpoint of the table. The engine must outlive the server, and is asked nothing after it.
void add_endpoints(HttpServer& server, Engine& engine);

}  // namespace papilio::server
