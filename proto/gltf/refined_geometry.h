#pragma once

#include <functional>

#include "papilio/refine.h"
#include "proto/gltf/encoded_geometry.h"
#include "proto/gltf/scene_mesh.h"

namespace papilio::proto::gltf {

/// Returns the geometry of a refined mesh, with all that the input has at its vertices. Primitives that have lost all
/// triangles are left out, and stay as they are. `adds_normals`: gives NORMAL to a mesh without. `poll` is called now
/// and then, and may throw to stop.
[[nodiscard]] NewGeometry refined_geometry(const SceneMesh& mesh, Result result, bool adds_normals,
                                           const std::function<void()>& poll);

/// Returns the geometry of a mesh as it came.
[[nodiscard]] NewGeometry unrefined_geometry(const SceneMesh& mesh);

/// Returns about the bytes that parting a refined mesh into primitives takes beside what is written. `is_compressed`:
/// what is written is smaller than the parts.
[[nodiscard]] uint64_t parting_bytes(const SceneMesh& mesh, const Mesh& refined, bool is_compressed);

/// Returns an upper bound of the memory for parting a refined mesh into primitives and writing them. `primitives`:
/// those of the mesh in the document.
[[nodiscard]] OutputBytes output_bytes(const SceneMesh& mesh, const Json& primitives, Compression requested);

}  // namespace papilio::proto::gltf
