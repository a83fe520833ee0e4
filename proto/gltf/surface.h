#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/geometry.h"

// All primitives of a mesh as one surface. The core carries for each point the coarse face that it lies in and its
// place there; everything else is computed from these and from the input's vertices.

namespace papilio::proto::gltf {

/// A surface to refine.
struct Surface {
  Mesh mesh;          ///< with the attributes of `Provenance`
  BuildReport found;  ///< points that only share a position among primitives are not counted as welded
  std::vector<uint32_t>
      primitive_of;  ///< of the input's triangles, all primitives in order: in MeshGeometry::primitives
  std::vector<Triangle> vertices_of;  ///< of them: in the set of the primitive; equal vertices are one
  bool has_normals = false;           ///< whether any set has them: the second attribute
};

/// Joins the triangles of all primitives by position. Throws `Error`: not_finite, no_faces, out_of_memory.
[[nodiscard]] Surface join_primitives(const MeshGeometry& geometry);

/// A vertex of the result as a mean of up to three of the input, in ascending order; unused ones have no weight.
struct Combination {
  std::array<uint32_t, 3> vertex{};
  std::array<double, 3> weight{};

  /// Returns whether it is a vertex of the input.
  [[nodiscard]] bool is_original() const { return weight[0] == 1; }
  /// Returns the vertex of the largest weight; of equal ones the lowest.
  [[nodiscard]] uint32_t nearest() const;
  friend bool operator==(const Combination&, const Combination&) = default;
  friend bool operator<(const Combination& a, const Combination& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.weight < b.weight;
  }
};

/// A vertex of the result.
struct RefinedVertex {
  Combination of;
  Vec3f position;
  Vec3d normal;  ///< of length one, where the surface has normals
};

/// A refined surface by primitives.
struct RefinedPrimitives {
  std::vector<std::vector<RefinedVertex>> sets;    ///< as MeshGeometry::sets
  std::vector<std::vector<Triangle>> triangles{};  ///< as MeshGeometry::primitives
};

/// Takes a refinement of `surface.mesh` apart into its primitives. `normals`: number of the attribute with the normals.
[[nodiscard]] RefinedPrimitives part_primitives(const MeshGeometry& geometry, const Surface& surface,
                                                const Mesh& refined, std::optional<size_t> normals);

}  // namespace papilio::proto::gltf
