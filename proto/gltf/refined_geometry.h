#pragma once

#include <functional>

#include "papilio/refine.h"
#include "proto/gltf/encoded_geometry.h"
#include "proto/gltf/scene_mesh.h"

namespace papilio::proto::gltf {

/// Returns the geometry of a refined mesh, with all vertex data of the input. Primitives without triangles are skipped,
/// and stay unchanged in the document. `adds_normals`: whether a mesh without NORMAL gets it. `poll` is called
/// regularly, and may throw to stop.
[[nodiscard]] NewGeometry refined_geometry(const SceneMesh& mesh, Result result, bool adds_normals,
                                           const std::function<void()>& poll);

/// Returns the unrefined geometry of a mesh.
[[nodiscard]] NewGeometry unrefined_geometry(const SceneMesh& mesh);

/// Estimates the bytes for dividing a refined mesh into primitives, beside the written bytes. `is_compressed`: whether
/// the written bytes are smaller than the primitives.
[[nodiscard]] uint64_t parting_bytes(const SceneMesh& mesh, const Mesh& refined, bool is_compressed);

/// Returns an upper bound of the memory for dividing a refined mesh into primitives and writing them. `primitives`: the
/// mesh's primitives in the document.
[[nodiscard]] OutputBytes output_bytes(const SceneMesh& mesh, const Json& primitives, Compression requested);

}  // namespace papilio::proto::gltf
