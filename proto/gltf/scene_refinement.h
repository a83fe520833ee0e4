#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "proto/gltf/decoded_scene.h"
#include "proto/limits.h"
#include "proto/parameters.h"
#include "proto/refinement.h"

// The pipeline from a glTF scene to a refined glTF scene. Server and client share it, so local and remote results are
// byte-identical.

namespace papilio::proto::gltf {

/// One refinement of a scene. The constructor reads and checks, run() refines. Statistics count vertices and faces of
/// all meshes, each once.
///
/// Parameters apply to the scene: `tolerance` is a share of its box's diagonal, `max_faces` bounds the faces of all
/// meshes together, and a view sees the instances in the scene. A mesh is refined once, fine enough for all of its
/// nodes, unless `split_instances` gives each node its own. Meshes without triangles or instances stay unchanged.
/// External buffers and `simplify_hidden` are refused.
class SceneRefinement {
 public:
  /// Reads and checks a scene; `bytes` must outlive this. Throws `Problem`, also if the result is certain to exceed a
  /// limit.
  SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits);
  SceneRefinement(std::shared_ptr<const std::string> bytes, const Parameters& parameters, const Limits& limits);
  /// Refines a cached scene, whose instances are not split. Results are byte-identical to those from its bytes.
  SceneRefinement(std::shared_ptr<const SharedScene> shared, const Parameters& parameters, const Limits& limits);
  SceneRefinement(const SceneRefinement&) = delete;
  SceneRefinement& operator=(const SceneRefinement&) = delete;
  ~SceneRefinement();

  [[nodiscard]] uint64_t coarse_faces() const;
  [[nodiscard]] uint64_t coarse_vertices() const;
  [[nodiscard]] BuildReport found() const;

  /// Refines and writes the scene; call once. Returns a .glb file. `on_level` of the hooks receives scenes whose meshes
  /// have at most 0, 1, 2, .. levels; each is refined and written separately. Throws `Problem`.
  [[nodiscard]] EncodedLevel run(const RefinementHooks& hooks = {});

 private:
  class State;
  std::shared_ptr<const std::string> bytes_;  ///< owned bytes; null if the caller owns them
  std::unique_ptr<State> state_;
};

}  // namespace papilio::proto::gltf
