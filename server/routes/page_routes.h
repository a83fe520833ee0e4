#pragma once

#include "server/engine.h"
#include "server/http/http.h"

// The viewer, and the meshes to try it with.

namespace papilio::server {

/// GET /: the page, asked for anew each time (ETag, 304). Throws `Problem` not_found where there is none.
[[nodiscard]] Response page_route(Engine& engine, Request& request);
/// GET /assets/{name}: what the page consists of, under names that change with the content: to be kept for ever.
[[nodiscard]] Response asset_route(Engine& engine, Request& request);
/// GET /v1/samples/{name}: a sample's Draco bytes.
[[nodiscard]] Response sample_route(Engine& engine, Request& request);

}  // namespace papilio::server
