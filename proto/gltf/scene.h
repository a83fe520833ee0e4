#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "proto/gltf/geometry.h"
#include "proto/gltf/matrix.h"

// Instances of a document's meshes.

namespace papilio::proto::gltf {

/// Instance of a mesh.
struct Instance {
  Affine map;                    ///< map from the mesh to the scene; unused for a skinned mesh
  std::optional<uint32_t> skin;  ///< index in `Scene::skins`
};

/// Placement of all meshes.
struct Scene {
  std::vector<std::vector<Instance>> instances;  ///< [mesh] instances
  std::vector<std::vector<Affine>> skins;        ///< [skin][joint] map from the mesh in its bind pose to the scene
  size_t nodes = 0;
};

/// Upper bound of the instances of all meshes together.
inline constexpr uint64_t most_instances = 1'000'000;

/// Reads the nodes of all scenes, without animations. If no node has a mesh, each mesh gets one instance with the
/// identity map. EXT_mesh_gpu_instancing adds all of its instances. Throws `Problem`: mesh_not_gltf (a node in its own
/// subtree, a malformed transform), mesh_too_large.
[[nodiscard]] Scene read_scene(Views& views);

/// Returns [instance] the maps that move the vertices of a mesh: one, or the maps of the joints that it uses.
[[nodiscard]] std::vector<std::vector<Affine>> maps_of(const Scene& scene, uint32_t mesh, const MeshGeometry& geometry);

/// Extends `box` by all instances of a mesh.
void extend_box(Box& box, const Scene& scene, uint32_t mesh, const MeshGeometry& geometry);

}  // namespace papilio::proto::gltf
