#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "proto/refinement.h"
#include "server/engine.h"
#include "server/http/http.h"

// What all routes that answer a refined mesh have in common.

namespace papilio::server {

inline constexpr const char* draco_type = "application/x-draco";
inline constexpr const char* bytes_type = "application/octet-stream";
inline constexpr const char* scene_type = "model/gltf-binary";
inline constexpr const char* multipart_type = "multipart/mixed";
inline constexpr const char* json_type = "application/json";

/// Which form of a refined mesh or scene the client likes best: draco_type, scene_type, bytes_type or multipart_type.
/// What it was is preferred. Throws `Problem` not_acceptable.
[[nodiscard]] std::string negotiate_refined(const Request& request, bool is_scene);

/// Returns the mesh of a scene of one as `proto::decode_mesh` takes it: a packed model as it is, another as Draco, to
/// the bit. Throws `Problem`, not_acceptable for other scenes.
[[nodiscard]] std::string mesh_of_scene(const std::string& glb, const proto::Limits& limits);
/// A Draco mesh of our own as a .glb scene of one.
[[nodiscard]] std::string scene_of_draco(const std::string& draco);

/// The statistics of a mesh as headers. The caller adds the mesh, and what caches may do with it.
[[nodiscard]] Response refined_response(const proto::Statistics& made, const std::string& type);

/// Streams each level as it is made, and a JSON summary. The work is done on a thread of its own, so that the slot is
/// free as soon as it is done, however slowly the client reads; it stops within a check when the client goes away. Once
/// a stream has begun its status is sent; what goes wrong then comes as its last part, `application/problem+json`.
/// `type` of the levels: draco_type or scene_type. `run`: the refinement's, which `run` owns.
using RunRefinement = std::function<proto::EncodedLevel(proto::RefinementHooks, Admission::Slot&)>;
[[nodiscard]] Response level_stream(Engine& engine, Request& request, std::shared_ptr<Admission::Slot> slot,
                                    const std::string& type, RunRefinement run);

/// The same of a refinement of a mesh or a scene.
template <class AnyRefinement>
[[nodiscard]] RunRefinement run_of(Engine& engine, std::shared_ptr<AnyRefinement> refinement) {
  return [&engine, refinement = std::move(refinement)](proto::RefinementHooks hooks, Admission::Slot& slot) {
    return engine.run(*refinement, std::move(hooks), slot);
  };
}

}  // namespace papilio::server
