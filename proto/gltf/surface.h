#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilio/detail.h"
#include "proto/gltf/geometry.h"

// All primitives of a mesh as one surface. The core carries for each point the coarse face that it lies in, its place
// there, its normal, and how far morph targets move it; everything else is computed from these and from the input's
// vertices.

namespace papilio::proto::gltf {

/// A surface to refine.
struct Surface {
  Mesh mesh;          ///< with the attributes of `Provenance`
  BuildReport found;  ///< points that only share a position among primitives are not counted as welded
  std::vector<uint32_t>
      primitive_of;              ///< of the input's triangles, all primitives in order: in MeshGeometry::primitives
  Buffer<Triangle> vertices_of;  ///< of them: in the set of the primitive; equal vertices are one
  bool has_normals = false;      ///< whether any set has them: the second attribute
  size_t target_count = 0;       ///< of morph targets: the attributes behind are their displacements
  /// Numbers of the attributes with the texture coordinates and colours of a packed model, the last ones, which its
  /// levels give.
  std::optional<size_t> texcoords{}, colours{};
  NormalStyle normals{};  ///< of a packed model's original

  [[nodiscard]] size_t first_displacement() const { return has_normals ? 2 : 1; }
};

/// Joins the triangles of all primitives by position. Throws `Error`: not_finite, no_faces, out_of_memory.
[[nodiscard]] Surface join_primitives(const MeshGeometry& geometry);

/// Adds the texture coordinates of a packed model's surface, TEXCOORD_0, and its colours, COLOR_0, as attributes of the
/// mesh. Leaves those out that not all sets have as packed models do.
void add_packed_values(const MeshGeometry& geometry, Surface& surface);

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
  Vec3d normal;        ///< of length one, where the surface has normals
  uint32_t point = 0;  ///< of the refined mesh
};

/// The points of a refined surface, as what they are made of.
class RefinedPoints {
 public:
  /// All must outlive it, but for the refined mesh's connectivity, which may be freed afterwards. `normals`: number of
  /// the attribute with the normals.
  RefinedPoints(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined,
                std::optional<size_t> normals);

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(vertex_.size()); }
  /// Whether any face has the point.
  [[nodiscard]] bool is_used(uint32_t point) const { return vertex_[point] != none; }
  /// The set, in MeshGeometry::sets, of the point's primitive.
  [[nodiscard]] uint32_t set(uint32_t point) const;
  /// The vertex of the refined mesh.
  [[nodiscard]] uint32_t vertex(uint32_t point) const { return vertex_[point]; }
  [[nodiscard]] Combination combination(uint32_t point) const;
  [[nodiscard]] RefinedVertex refined_vertex(uint32_t point) const;
  /// The primitive, in MeshGeometry::primitives, of the point.
  [[nodiscard]] uint32_t primitive(uint32_t point) const;

 private:
  [[nodiscard]] const double* provenance_of(uint32_t point) const;

  const MeshGeometry& geometry_;
  const Surface& surface_;
  const Mesh& refined_;
  std::optional<size_t> normals_;
  std::vector<uint32_t> vertex_;  ///< of each point; `none` where no face has it
};

/// Some of them, each of which becomes a vertex: computed where it is asked for, as there are many.
struct RefinedVertices {
  const RefinedPoints* points = nullptr;
  std::vector<uint32_t> numbers{};

  [[nodiscard]] size_t size() const { return numbers.size(); }
  [[nodiscard]] RefinedVertex operator[](size_t i) const { return points->refined_vertex(numbers[i]); }
};

/// A refined surface by primitives.
struct RefinedPrimitives {
  std::vector<RefinedVertices> sets;          ///< as MeshGeometry::sets
  std::vector<Buffer<Triangle>> triangles{};  ///< as MeshGeometry::primitives
};

/// Takes a refinement apart into the primitives of the surface. The points must outlive it.
[[nodiscard]] RefinedPrimitives part_primitives(const MeshGeometry& geometry, const RefinedPoints& points,
                                                const Mesh& refined);

}  // namespace papilio::proto::gltf
