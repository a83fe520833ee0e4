#pragma once

#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// Answers POST /v1/refine. The body is the mesh, with parameters in the query, or a form with the parts `mesh` and
/// `params`. The answer is the refined mesh, or with `Accept: multipart/mixed` each level as it is made and a JSON
/// summary. Throws `Problem`.
[[nodiscard]] Response refine_route(Engine& engine, Request& request);

}  // namespace papilio::server
