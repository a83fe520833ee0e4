#pragma once

#include "server/engine.h"
#include "server/http/http.h"

namespace papilio::server {

/// POST /v1/refine: the mesh as the body with parameters in the query, or a form with parts `mesh` and
/// `params`. Answers the refined mesh, or with `Accept: multipart/mixed` each level as it is made and a JSON
/// summary. Throws `Problem`.
[[nodiscard]] Response refine_route(Engine& engine, Request& request);

}  // namespace papilio::server
