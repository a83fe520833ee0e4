#include "server/routes/page_routes.h"

#include "proto/problem.h"
#include "server/accept.h"
#include "server/routes/mesh_routes.h"
#include "server/routes/refined_answer.h"
#include "server/sha256.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

namespace {

/// Policy of the page: it runs its own scripts and Draco's decoder (WebAssembly, in a worker made from a blob),
/// connects to this server only, and cannot be framed. Textures in .glb files are blobs and data URIs.
constexpr const char* content_security_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; "
    "connect-src 'self' blob: data:; img-src 'self' data: blob:; style-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

Response answer(const Request& request, const PageFile& file, const std::string& cache_control) {
  const bool gzipped = file.gzipped != nullptr && accepts_gzip(request.header("Accept-Encoding"));
  std::string tag = file.entity_tag;
  if (gzipped) tag.insert(tag.size() - 1, "-gz");  // two representations never share a tag
  Response response;
  response.headers = {{"ETag", tag}, {"Cache-Control", cache_control}, {"Vary", "Accept-Encoding"}};
  if (none_match_has(request.header("If-None-Match"), tag)) {
    response.status = 304;
    return response;
  }
  response.content_type = file.content_type;
  if (gzipped) response.headers.emplace_back("Content-Encoding", "gzip");
  response.shared = gzipped ? file.gzipped : file.bytes;
  return response;
}

}  // namespace

Response page_route(Engine& engine, Request& request) {
  const PageFile* const index = engine.page().index();
  if (index == nullptr)
    throw Problem(Code::not_found,
                  "This server has no viewer: `./dev build` makes it, and --web says where it is. GET /openapi.json "
                  "lists what there is.");
  Response response = answer(request, *index, "no-cache");
  response.headers.emplace_back("Content-Security-Policy", content_security_policy);
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  return response;
}

Response asset_route(Engine& engine, Request& request) {
  const PageFile* const file = engine.page().asset(request.path_parameter("name"));
  if (file == nullptr)
    throw Problem(Code::not_found, "The page has no such file; reload the page: it may be of another version.");
  return answer(request, *file, "public, max-age=31536000, immutable");
}

Response sample_route(Engine& engine, Request& request) {
  const Sample* const sample = engine.samples().find(request.path_parameter("name"));
  if (sample == nullptr) throw Problem(Code::not_found, "There is no such sample; GET /v1/info lists them.");
  Response response;
  const std::string tag = '"' + sha256(*sample->draco).substr(0, 32) + '"';
  response.headers = {{"ETag", tag}, {"Cache-Control", "no-cache"}};
  if (none_match_has(request.header("If-None-Match"), tag)) {
    response.status = 304;
    return response;
  }
  response.content_type = draco_type;
  response.shared = sample->draco;
  return response;
}

}  // namespace papilio::server
