#include "server/endpoints.h"

#include <array>

#include "server/openapi.h"
#include "server/routes/mesh_routes.h"
#include "server/routes/page_routes.h"
#include "server/routes/refine_route.h"
#include "server/routes/service_routes.h"

namespace papilio::server {
namespace {

using proto::Code;
using Codes = std::vector<Code>;

Codes operator+(Codes a, const Codes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Codes body_codes{Code::length_required,        Code::body_too_large,       Code::request_timeout,
                       Code::unsupported_media_type, Code::unsupported_encoding, Code::bad_request};
const Codes mesh_codes{Code::mesh_not_draco, Code::mesh_not_gltf, Code::mesh_unsupported, Code::mesh_unusable,
                       Code::mesh_too_large};
const Codes work_codes{Code::busy, Code::cancelled};
const Codes refine_codes{Code::bad_parameter,  Code::unknown_parameter, Code::not_acceptable, Code::result_too_large,
                         Code::takes_too_long, Code::mesh_too_large,    Code::mesh_unusable};
const Codes store_codes{Code::mesh_not_found, Code::store_unavailable};

const std::array table{
    Endpoint{"POST", "/v1/refine", "refine", "Refines the mesh in the body", Access::use, WhileDraining::refuse, true,
             Input::mesh_or_form, Output::refined, refine_codes + body_codes + mesh_codes + work_codes, refine_route},
    Endpoint{"POST", "/v1/meshes", "storeMesh", "Stores a mesh under the SHA-256 of its bytes", Access::use,
             WhileDraining::refuse, false, Input::mesh, Output::description,
             body_codes + mesh_codes + work_codes +
                 Codes{Code::store_unavailable, Code::store_full, Code::unknown_parameter, Code::result_too_large},
             store_mesh},
    Endpoint{"GET", "/v1/meshes/{id}", "storedMesh", "A stored mesh, or with Accept: application/json its description",
             Access::use, WhileDraining::refuse, false, Input::none, Output::mesh,
             store_codes + mesh_codes + work_codes + Codes{Code::not_acceptable, Code::result_too_large}, stored_mesh},
    Endpoint{"DELETE", "/v1/meshes/{id}", "deleteMesh", "Takes a mesh out of the store", Access::manage,
             WhileDraining::refuse, false, Input::none, Output::nothing, store_codes, delete_mesh},
    Endpoint{"GET", "/v1/meshes/{id}/refined", "refinedMesh", "Refines a stored mesh; caches may keep the answer",
             Access::use, WhileDraining::refuse, true, Input::none, Output::refined,
             store_codes + refine_codes + mesh_codes + work_codes, refined_mesh},
    Endpoint{"POST", "/v1/meshes/{id}/refined", "refineStoredMesh",
             "Refines a stored mesh, with the parameters as JSON", Access::use, WhileDraining::refuse, false,
             Input::parameters, Output::refined, store_codes + refine_codes + mesh_codes + body_codes + work_codes,
             refined_mesh},
    Endpoint{"GET",
             "/v1/info",
             "info",
             "Version, limits, schemes and parameters",
             Access::open,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::info,
             {},
             info_route},
    Endpoint{"GET",
             "/v1/samples/{name}",
             "sample",
             "A mesh to try things with",
             Access::use,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::sample,
             {Code::not_found},
             sample_route},
    Endpoint{"GET",
             "/",
             "viewer",
             "The viewer, a page for browsers",
             Access::open,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::page,
             {Code::not_found},
             page_route},
    Endpoint{"GET",
             "/assets/{name}",
             "viewerFile",
             "What the viewer consists of",
             Access::open,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::asset,
             {Code::not_found},
             asset_route},
    Endpoint{"GET",
             "/openapi.json",
             "openapi",
             "This document",
             Access::open,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::openapi,
             {},
             openapi_route},
    Endpoint{"GET",
             "/health",
             "health",
             "Whether the server is alive; never waits on work",
             Access::open,
             WhileDraining::answer,
             false,
             Input::none,
             Output::health,
             {},
             health_route},
    Endpoint{"GET",
             "/ready",
             "ready",
             "Whether a request would be let in now",
             Access::open,
             WhileDraining::refuse,
             false,
             Input::none,
             Output::health,
             {Code::not_ready},
             ready_route},
    Endpoint{"GET",
             "/metrics",
             "metrics",
             "Counters and histograms for Prometheus",
             Access::manage,
             WhileDraining::answer,
             false,
             Input::none,
             Output::metrics,
             {},
             metrics_route},
};

constexpr std::array common{Code::bad_request,       Code::unauthorized,        Code::forbidden,
                            Code::headers_too_large, Code::range_not_supported, Code::method_not_allowed,
                            Code::draining,          Code::out_of_memory,       Code::internal};

}  // namespace

std::span<const Endpoint> endpoints() { return table; }
std::span<const Code> common_problems() { return common; }

void add_endpoints(HttpServer& server, Engine& engine) {
  engine.observe_held_bytes([&server] { return server.held(); });
  for (const Endpoint& endpoint : endpoints())
    server.add(std::string(endpoint.method), std::string(endpoint.path),
               [&engine, &endpoint](Request& request) { return endpoint.answer(engine, request); },
               {.while_draining = endpoint.while_draining, .access = endpoint.access});
}

}  // namespace papilio::server
