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

/// One refinement of a scene. The constructor reads and checks, `run` refines. Statistics count vertices and faces of
/// all meshes, each once.
///
/// Parameters hold for the scene: `tolerance` is a share of its box's diagonal, `max_faces` bounds the faces of all
/// meshes together, a view sees the meshes where the nodes show them. A mesh is refined once, as finely as any of its
/// nodes needs, unless `split_instances` gives each node its own. External buffers are refused. Meshes without
/// triangles, and those that no node shows, stay as they are. `simplify_hidden` is refused.
class SceneRefinement {
 public:
  /// Throws `Problem`, also if the result is certain to exceed a limit. `bytes` must outlive it.
  SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits);
  SceneRefinement(std::shared_ptr<const std::string> bytes, const Parameters& parameters, const Limits& limits);
  /// Refines a cached scene, whose instances are not split. Results are byte-identical to those from the bytes.
  SceneRefinement(std::shared_ptr<const SharedScene> shared, const Parameters& parameters, const Limits& limits);
  SceneRefinement(const SceneRefinement&) = delete;
  SceneRefinement& operator=(const SceneRefinement&) = delete;
  ~SceneRefinement();

  [[nodiscard]] uint64_t coarse_faces() const;
  [[nodiscard]] uint64_t coarse_vertices() const;
  [[nodiscard]] BuildReport found() const;

  /// Refines and writes; call once. Returns the scene as a .glb file. `on_level` of the hooks receives scenes whose
  /// meshes have at most so many levels, coarse first; each is refined and written anew. Throws `Problem`.
  [[nodiscard]] EncodedLevel run(const RefinementHooks& hooks = {});

 private:
  class State;
  std::shared_ptr<const std::string> bytes_;  ///< null: they are the caller's
  std::unique_ptr<State> state_;
};

}  // namespace papilio::proto::gltf
