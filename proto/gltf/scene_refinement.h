#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proto/gltf/geometry_writer.h"
#include "proto/limits.h"
#include "proto/parameters.h"
#include "proto/refinement.h"

// The pipeline from a glTF scene to a refined glTF scene. Server and client share it, so local and remote results are
// byte-identical.

namespace papilio::proto::gltf {

/// Returns the bytes of the file that a document names by a relative URI.
using FileResolver = std::function<std::string(const std::string& uri)>;

/// How a refined scene is written.
struct SceneOutput {
  Compression compression = Compression::same;
  bool as_glb = true;                     ///< else JSON, and the buffers as files of their own
  std::string binary_name = "scene.bin";  ///< of the binary chunk in a file of its own
};

/// A refined scene with its statistics: vertices and faces of all meshes, each counted once.
struct RefinedScene {
  std::string document;
  std::vector<std::pair<std::string, std::string>> buffers{};  ///< files beside the document: URI and bytes
  Statistics statistics{};
};

/// One refinement of a scene. The constructor reads and checks, `run` refines.
///
/// Parameters hold for the scene: `tolerance` is a share of its box's diagonal, `max_faces` bounds the faces of all
/// meshes together, a view sees the meshes where the nodes show them. A mesh is refined once, as finely as any of its
/// nodes needs. Meshes without triangles, and those that no node shows, stay as they are. `simplify_hidden` is refused.
class SceneRefinement {
 public:
  /// Throws `Problem`, also if the result is certain to exceed a limit. `bytes` must outlive it.
  SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits,
                  const FileResolver& resolve = {});
  SceneRefinement(const SceneRefinement&) = delete;
  SceneRefinement& operator=(const SceneRefinement&) = delete;
  ~SceneRefinement();

  [[nodiscard]] uint64_t coarse_faces() const;
  [[nodiscard]] uint64_t coarse_vertices() const;
  [[nodiscard]] BuildReport found() const;

  /// Refines and writes; call once. `on_level` of the hooks is not called. Throws `Problem`.
  [[nodiscard]] RefinedScene run(const SceneOutput& output = {}, const RefinementHooks& hooks = {});

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace papilio::proto::gltf
