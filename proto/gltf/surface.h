#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilio/detail.h"
#include "proto/gltf/geometry.h"

// All primitives of a mesh as one surface. For each point, the core refines its coarse face, its barycentric
// coordinates, its normal, and its displacements by morph targets. All other values follow from these and the input's
// vertices.

namespace papilio::proto::gltf {

/// Attribute of vertices, of one component, that holds the smoothing groups of the faces at them
/// (`Attribute::is_smoothing_group`). Sets of vertices without it are of group 1.
inline constexpr const char* smoothing_group_semantic = "_SMOOTHING_GROUP";
inline constexpr double default_smoothing_group = 1;

/// Surface to refine.
struct Surface {
  Mesh mesh;          ///< mesh with the attributes of `Provenance`
  BuildReport found;  ///< defects; points that share a position among primitives do not count as welded
  std::vector<uint32_t> primitive_of;  ///< [input's triangles] index in MeshGeometry::primitives
  Buffer<Triangle> vertices_of;        ///< [input's triangles] vertices in the primitive's set, with equal ones merged
  bool has_normals = false;            ///< whether any set has normals; they are the second attribute
  size_t target_count = 0;             ///< number of morph targets, whose displacements are the next attributes, before
                                       ///< smoothing groups, if any set has them
  /// Indices of the last attributes, with the texture coordinates and colours of a packed model's levels.
  std::optional<size_t> texcoords{}, colours{};
  NormalStyle normals{};  ///< style of a packed model's original normals

  [[nodiscard]] size_t first_displacement() const { return has_normals ? 2 : 1; }
};

/// Joins the triangles of all primitives by position. Throws `Error`: not_finite, no_faces, out_of_memory.
[[nodiscard]] Surface join_primitives(const MeshGeometry& geometry);

/// Adds the texture coordinates of a packed model's surface, TEXCOORD_0, and its colours, COLOR_0, as attributes of the
/// mesh. Skips attributes that a set lacks, or has in another format than packed models.
void add_packed_values(const MeshGeometry& geometry, Surface& surface);

/// Vertex of the result as a weighted mean of up to three vertices of the input, in ascending order. Unused ones have
/// the weight 0.
struct Combination {
  std::array<uint32_t, 3> vertex{};
  std::array<double, 3> weight{};

  /// Returns whether it is a vertex of the input.
  [[nodiscard]] bool is_original() const { return weight[0] == 1; }
  /// Returns the vertex of the largest weight; the lowest of several.
  [[nodiscard]] uint32_t nearest() const;
  friend bool operator==(const Combination&, const Combination&) = default;
  friend bool operator<(const Combination& a, const Combination& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.weight < b.weight;
  }
};

/// Vertex of the result.
struct RefinedVertex {
  Combination of;
  Vec3f position;
  Vec3d normal;        ///< unit normal, if the surface has normals
  uint32_t point = 0;  ///< point of the refined mesh
};

/// Points of a refined surface, and their origin in the input.
class RefinedPoints {
 public:
  /// Refers to all arguments, which must outlive this; but the refined mesh's connectivity may be freed afterwards.
  /// `normals`: number of the attribute with normals.
  RefinedPoints(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined,
                std::optional<size_t> normals);

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(vertex_.size()); }
  /// Returns whether any face has the point.
  [[nodiscard]] bool is_used(uint32_t point) const { return vertex_[point] != none; }
  /// Returns the index of the point's set in MeshGeometry::sets.
  [[nodiscard]] uint32_t set(uint32_t point) const;
  /// Returns the point's vertex of the refined mesh.
  [[nodiscard]] uint32_t vertex(uint32_t point) const { return vertex_[point]; }
  [[nodiscard]] Combination combination(uint32_t point) const;
  [[nodiscard]] RefinedVertex refined_vertex(uint32_t point) const;
  /// Returns the index of the point's primitive in MeshGeometry::primitives.
  [[nodiscard]] uint32_t primitive(uint32_t point) const;

 private:
  [[nodiscard]] const double* provenance_of(uint32_t point) const;

  const MeshGeometry& geometry_;
  const Surface& surface_;
  const Mesh& refined_;
  std::optional<size_t> normals_;
  std::vector<uint32_t> vertex_;  ///< [points] vertex; `none` for unused points
};

/// Refined points that become vertices of one set. Vertices are computed on demand, to save memory.
struct RefinedVertices {
  const RefinedPoints* points = nullptr;
  std::vector<uint32_t> numbers{};

  [[nodiscard]] size_t size() const { return numbers.size(); }
  [[nodiscard]] RefinedVertex operator[](size_t i) const { return points->refined_vertex(numbers[i]); }
};

/// Refined surface by primitives.
struct RefinedPrimitives {
  std::vector<RefinedVertices> sets;          ///< vertices in the order of MeshGeometry::sets
  std::vector<Buffer<Triangle>> triangles{};  ///< triangles in the order of MeshGeometry::primitives
};

/// Divides a refinement into the primitives of the surface. The points must outlive the result.
[[nodiscard]] RefinedPrimitives part_primitives(const MeshGeometry& geometry, const RefinedPoints& points,
                                                const Mesh& refined);

}  // namespace papilio::proto::gltf
