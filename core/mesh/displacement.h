#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "mesh/marks.h"
#include "papilio/mesh.h"

namespace papilio {

/// Displacement attribute as vectors at the vertices or edges of a level. Vertices whose points differ, and new
/// vertices that depend on them, are NaN.
struct Displacement {
  uint32_t attribute;  ///< number in the mesh
  Buffer<Vec3d> at;    ///< [V] values at the vertices, or [E] at the new vertices of edges
  /// Values of the points on the half-edges of a whole level [H * components], in place of `at`; they must outlive
  /// this. The attribute is then no displacement.
  std::span<const float> given{};
  uint32_t components = 0;  ///< components of `given`
  /// Parent face, in the whole level, of every twelve half-edges of a partial level; empty if the level is whole.
  std::span<const uint32_t> parent{};

  /// Returns the given values on a half-edge of the level.
  [[nodiscard]] std::span<const float> given_at(uint32_t half_edge) const {
    const size_t whole = parent.empty() ? half_edge : 12 * parent[half_edge / 12] + half_edge % 12;
    return given.subspan(whole * components, components);
  }
};
using Displacements = std::vector<Displacement>;

/// Returns the mesh's displacement attributes at its vertices. O(H).
[[nodiscard]] Displacements displacements_at_vertices(const Mesh& mesh);

/// Appends the displacements at the new vertices of marked edges, in their order, to those of the vertices.
void append_new_vertices(Displacements& at_vertices, const Displacements& at_edges, const Marks& split);

[[nodiscard]] bool has_displacements(const PointAttributes& attributes);

/// Returns whether a displacement is not NaN.
[[nodiscard]] inline bool is_known(Vec3d displacement) { return !std::isnan(displacement.x); }

/// Returns a displacement of NaN.
[[nodiscard]] Vec3d unknown_displacement();

}  // namespace papilio
