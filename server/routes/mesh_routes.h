#pragma once

#include <string>

#include "server/engine.h"
#include "server/http/http.h"

// Stored meshes, each under the SHA-256 of its bytes.

namespace papilio::server {

/// POST /v1/meshes: stores the mesh in the body once it is known to be one that can be refined. 201 with `Location`, or
/// 200 when it was there already; the description as JSON.
[[nodiscard]] Response store_mesh(Engine& engine, Request& request);
/// GET and HEAD /v1/meshes/{id}: the stored bytes, or with `Accept: application/json` the description.
[[nodiscard]] Response stored_mesh(Engine& engine, Request& request);
/// DELETE /v1/meshes/{id}: 204.
[[nodiscard]] Response delete_mesh(Engine& engine, Request& request);
/// GET, HEAD and POST /v1/meshes/{id}/refined: the refined mesh, with parameters in the query or (POST) as a JSON body.
/// Strong `ETag`; 304 where `If-None-Match` has it.
[[nodiscard]] Response refined_mesh(Engine& engine, Request& request);

/// The id in the request's path. Throws `Problem` mesh_not_found when it cannot be one.
[[nodiscard]] std::string mesh_id(const Request& request);
/// The strong entity tag, quotes included, of a result: it depends on the mesh, the parameters in their canonical form,
/// the type, and on all that results depend on besides (proto/results_version.h). Servers of other versions whose
/// results are the same give the same tag.
[[nodiscard]] std::string entity_tag(const std::string& id, const proto::Parameters& parameters,
                                     const std::string& type);
/// Whether `If-None-Match` names the tag, by weak comparison (RFC 9110, section 13.1.2).
[[nodiscard]] bool none_match_has(const std::string& if_none_match, const std::string& tag);

}  // namespace papilio::server
