#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "papilio/refine.h"
#include "proto/gltf/mesh_options.h"
#include "proto/gltf/scene.h"
#include "proto/gltf/surface.h"

namespace papilio::proto::gltf {

/// Mesh of a scene, prepared for refinement.
struct SceneMesh {
  uint32_t number = 0;
  MeshGeometry geometry;
  Surface surface;
  double diagonal = 0;                    ///< diagonal of its bounding box
  std::vector<std::vector<Affine>> maps;  ///< [instance][joint] maps to the scene
  bool is_two_sided = false;              ///< whether it is open, and any of its materials is two-sided

  /// Returns the largest scale of its instances.
  [[nodiscard]] double scale() const;
  [[nodiscard]] PlacedMesh placed() const { return {surface.mesh, diagonal, maps, is_two_sided}; }
  [[nodiscard]] uint64_t coarse_faces() const { return surface.mesh.topology.face_count(); }
};

/// Meshes of a scene, and the diagonal of its box.
struct SceneMeshes {
  std::vector<SceneMesh> meshes;
  Box box{{1, 1, 1}, {-1, -1, -1}};
  uint64_t unchanged_faces = 0;  ///< faces of meshes that are not refined
};

/// Reads all meshes of triangles with an instance. Throws `Problem`: mesh_unusable if no mesh has a surface.
[[nodiscard]] SceneMeshes read_meshes(Views& views, const Limits& limits);

/// Returns the scene's tolerance, a length, at which all meshes together have at most `max_faces` faces, found by
/// bisection; 0 if no tolerance is needed. `faces_at` counts the faces at a tolerance.
[[nodiscard]] double tolerance_within_budget(uint64_t max_faces, double scene_diagonal,
                                             const std::function<uint64_t(double)>& faces_at);

}  // namespace papilio::proto::gltf
