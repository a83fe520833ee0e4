#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "mesh/split_plan.h"
#include "papilio/mesh.h"

namespace papilio {

/// An attribute that is a displacement, as vectors at the vertices or edges of a level; of vertices whose points
/// differ, and what depends on them, not a number.
struct Displacement {
  uint32_t attribute;  ///< number in the mesh
  Buffer<Vec3d> at;    ///< [V] at the vertices; or [E] at the new vertices of the edges
  /// In place of `at`: values of the points on the half-edges of a whole level [H * components], which must outlive
  /// this. The attribute is no displacement.
  std::span<const float> given{};
  uint32_t components = 0;  ///< of `given`
  /// Where not all of the level is at hand: the faces above, in the whole level, of every twelve half-edges.
  std::span<const uint32_t> parent{};

  /// Returns what is given on a half-edge of the level at hand.
  [[nodiscard]] std::span<const float> given_at(uint32_t half_edge) const {
    const size_t whole = parent.empty() ? half_edge : 12 * parent[half_edge / 12] + half_edge % 12;
    return given.subspan(whole * components, components);
  }
};
using Displacements = std::vector<Displacement>;

/// The mesh's attributes that are displacements, at its vertices. O(H).
[[nodiscard]] Displacements displacements_at_vertices(const Mesh& mesh);

/// Appends what is at the new vertices of the plan's edges to what is at the vertices, in their order.
void append_new_vertices(Displacements& at_vertices, const Displacements& at_edges, const SplitPlan& plan);

[[nodiscard]] bool has_displacements(const PointAttributes& attributes);

/// Whether it is a number.
[[nodiscard]] inline bool is_known(Vec3d displacement) { return !std::isnan(displacement.x); }

/// Is not a number.
[[nodiscard]] Vec3d unknown_displacement();

}  // namespace papilio
