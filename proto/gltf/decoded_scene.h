#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proto/gltf/document.h"
#include "proto/gltf/scene_mesh.h"
#include "proto/prepared_meshes.h"

namespace papilio::proto::gltf {

/// Decoded and checked scene.
struct DecodedScene {  // NOLINT(bugprone-exception-escape): moving JSON cannot throw
  Document document;
  SceneMeshes scene;
  bool is_packed = false;  ///< whether it is a packed model: its only mesh has levels of detail

  [[nodiscard]] uint64_t coarse_faces() const;
  [[nodiscard]] uint64_t coarse_vertices() const;
  [[nodiscard]] BuildReport found() const;
};

/// Reads a .glb file, including the levels of a packed model (proto/detail.md), or a .gltf file with embedded buffers;
/// refuses external buffers. `bytes` must outlive the result. `splits_instances`: whether each node gets a mesh of its
/// own (split_instances.h). Throws `Problem`.
[[nodiscard]] DecodedScene decode_scene(std::string_view bytes, const Limits& limits, bool splits_instances = false);

/// Decoded scene, shared by refinements, and a cache of prepared meshes. Thread-safe.
class SharedScene {
 public:
  /// `byte_budget`: limit of cached bytes, divided among the meshes by their faces. Throws `Problem`.
  SharedScene(std::shared_ptr<const std::string> bytes, const Limits& limits, uint64_t byte_budget);

  [[nodiscard]] const DecodedScene& decoded() const { return decoded_; }
  /// Returns mesh `mesh` of `SceneMeshes::meshes` prepared for the options' rules, as PreparedMeshes::for_rules_of().
  [[nodiscard]] std::shared_ptr<const PreparedMesh> for_rules_of(size_t mesh, const Options& options) const;
  /// Returns the bytes in memory.
  [[nodiscard]] uint64_t bytes() const;

 private:
  std::shared_ptr<const std::string> bytes_;
  DecodedScene decoded_;
  std::vector<std::unique_ptr<PreparedMeshes>> prepared_;
};

}  // namespace papilio::proto::gltf
