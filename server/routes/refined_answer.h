#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "proto/refinement.h"
#include "server/engine.h"
#include "server/http/http.h"

// Functions shared by the routes of refined meshes.

namespace papilio::server {

inline constexpr const char* draco_type = "application/x-draco";
inline constexpr const char* bytes_type = "application/octet-stream";
inline constexpr const char* scene_type = "model/gltf-binary";
inline constexpr const char* multipart_type = "multipart/mixed";
inline constexpr const char* json_type = "application/json";

/// Negotiates the type of a refined mesh or scene: draco_type, scene_type, bytes_type or multipart_type. The kind of
/// the input is preferred. Throws `Problem` not_acceptable.
[[nodiscard]] std::string negotiate_refined(const Request& request, bool is_scene);

/// Returns the mesh of a single-mesh scene in the form for proto::decode_mesh(): a packed model unchanged, another mesh
/// as exact Draco. Throws `Problem`, not_acceptable for other scenes.
[[nodiscard]] std::string mesh_of_scene(const std::string& glb, const proto::Limits& limits);
/// Returns a Draco mesh of the server as a .glb scene.
[[nodiscard]] std::string scene_of_draco(const std::string& draco);

/// Returns a response with the statistics of a mesh as headers. The caller adds the mesh, and Cache-Control.
[[nodiscard]] Response refined_response(const proto::Statistics& made, const std::string& type);

/// Function that runs a refinement, which it owns.
using RunRefinement = std::function<proto::EncodedLevel(proto::RefinementHooks, Admission::Slot&)>;
/// Streams each level as it is made, and a JSON summary. Works on a thread of its own, so that the slot is free as soon
/// as the work is done, however slowly the client reads. Stops within one check if the client leaves. The status is
/// sent first; a later problem is the last part, `application/problem+json`. `type` of the levels: draco_type or
/// scene_type.
[[nodiscard]] Response level_stream(Engine& engine, Request& request, std::shared_ptr<Admission::Slot> slot,
                                    const std::string& type, RunRefinement run);

/// Returns a function that runs a refinement of a mesh or a scene.
template <class AnyRefinement>
[[nodiscard]] RunRefinement run_of(Engine& engine, std::shared_ptr<AnyRefinement> refinement) {
  return [&engine, refinement = std::move(refinement)](proto::RefinementHooks hooks, Admission::Slot& slot) {
    return engine.run(*refinement, std::move(hooks), slot);
  };
}

}  // namespace papilio::server
