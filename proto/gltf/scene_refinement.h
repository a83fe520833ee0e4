#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "proto/limits.h"
#include "proto/parameters.h"
#include "proto/refinement.h"

// The pipeline from a glTF scene to a refined glTF scene. Server and client share it, so local and remote results are
// byte-identical.

namespace papilio::proto::gltf {

/// A refined scene as a .glb file with its statistics: vertices and faces of all meshes, each counted once.
struct RefinedScene {
  std::string glb;
  Statistics statistics{};
};

/// One refinement of a scene. The constructor reads and checks, `run` refines.
///
/// Parameters hold for the scene: `tolerance` is a share of its box's diagonal, `max_faces` bounds the faces of all
/// meshes together, a view sees the meshes where the nodes show them. A mesh is refined once, as finely as any of its
/// nodes needs. External buffers are refused. Meshes without triangles, and those that no node shows, stay as they are.
/// `simplify_hidden` is refused.
class SceneRefinement {
 public:
  /// Throws `Problem`, also if the result is certain to exceed a limit. `bytes` must outlive it.
  SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits);
  SceneRefinement(const SceneRefinement&) = delete;
  SceneRefinement& operator=(const SceneRefinement&) = delete;
  ~SceneRefinement();

  [[nodiscard]] uint64_t coarse_faces() const;
  [[nodiscard]] uint64_t coarse_vertices() const;
  [[nodiscard]] BuildReport found() const;

  /// Refines and writes; call once. `on_level` of the hooks is not called. Throws `Problem`.
  [[nodiscard]] RefinedScene run(const RefinementHooks& hooks = {});

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace papilio::proto::gltf
