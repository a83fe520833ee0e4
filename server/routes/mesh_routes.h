#pragma once

#include <string>

#include "server/engine.h"
#include "server/http/http.h"

// Routes of stored meshes, each under the SHA-256 of its bytes.

namespace papilio::server {

/// Answers POST /v1/meshes: checks that the mesh in the body can be refined, and stores it. 201 with `Location`, or 200
/// if it was already stored; the body is the description as JSON.
[[nodiscard]] Response store_mesh(Engine& engine, Request& request);
/// Answers GET and HEAD /v1/meshes/{id}: the stored bytes, or with `Accept: application/json` the description.
[[nodiscard]] Response stored_mesh(Engine& engine, Request& request);
/// Answers DELETE /v1/meshes/{id} with 204.
[[nodiscard]] Response delete_mesh(Engine& engine, Request& request);
/// Answers GET, HEAD and POST /v1/meshes/{id}/refined: the refined mesh, with parameters in the query, or in a JSON
/// body of POST. Strong `ETag`; 304 if `If-None-Match` has it.
[[nodiscard]] Response refined_mesh(Engine& engine, Request& request);

/// Returns the id in the request's path. Throws `Problem` mesh_not_found for an invalid one.
[[nodiscard]] std::string mesh_id(const Request& request);
/// Returns the strong entity tag of a result, with its quotes. It depends on the mesh, the canonical parameters, the
/// type, and the versions of results (proto/results_version.h). Servers with equal versions of results return equal
/// tags.
[[nodiscard]] std::string entity_tag(const std::string& id, const proto::Parameters& parameters,
                                     const std::string& type);
/// Returns whether `If-None-Match` contains the tag, by weak comparison (RFC 9110, section 13.1.2).
[[nodiscard]] bool none_match_has(const std::string& if_none_match, const std::string& tag);

}  // namespace papilio::server
