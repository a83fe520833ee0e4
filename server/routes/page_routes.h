#pragma once

#include "server/engine.h"
#include "server/http/http.h"

// Routes of the viewer and of its sample meshes.

namespace papilio::server {

/// Answers GET / with the page, to be revalidated each time (ETag, 304). Throws `Problem` not_found without a page.
[[nodiscard]] Response page_route(Engine& engine, Request& request);
/// Answers GET /assets/{name} with a file of the page. Names change with the content, so that caches may keep it
/// forever.
[[nodiscard]] Response asset_route(Engine& engine, Request& request);
/// Answers GET /v1/samples/{name} with a sample's Draco bytes.
[[nodiscard]] Response sample_route(Engine& engine, Request& request);

}  // namespace papilio::server
