#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "proto/gltf/geometry.h"
#include "proto/gltf/matrix.h"

// Where the meshes of a document are shown.

namespace papilio::proto::gltf {

/// One showing of a mesh.
struct Instance {
  Affine map;                    ///< from the mesh to the scene; of a skinned mesh unused
  std::optional<uint32_t> skin;  ///< number in `Scene::skins`
};

/// Placement of all meshes.
struct Scene {
  std::vector<std::vector<Instance>> instances;  ///< by mesh
  std::vector<std::vector<Affine>> skins;        ///< by skin and joint: from the mesh in its bind pose to the scene
  size_t nodes = 0;
};

/// Most showings of all meshes together.
inline constexpr uint64_t most_instances = 1'000'000;

/// Reads the nodes of all scenes as they stand, without animations. Where no node shows any mesh, each mesh is shown
/// once, as it is. EXT_mesh_gpu_instancing counts with each of its instances. Throws `Problem`: mesh_not_gltf (a node
/// in its own subtree, a malformed transform), mesh_too_large.
[[nodiscard]] Scene read_scene(Views& views);

/// Returns for each showing of a mesh the maps that move its vertices: one, or those of the joints that it uses.
[[nodiscard]] std::vector<std::vector<Affine>> maps_of(const Scene& scene, uint32_t mesh, const MeshGeometry& geometry);

/// Extends `box` by all showings of a mesh.
void extend_box(Box& box, const Scene& scene, uint32_t mesh, const MeshGeometry& geometry);

}  // namespace papilio::proto::gltf
