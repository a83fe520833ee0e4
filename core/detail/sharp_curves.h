#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Role of a vertex in the curves of a surface: its boundaries and creases.
enum class CurveRole : uint8_t {
  smooth,  ///< on no curve
  inner,   ///< inside a curve
  corner,  ///< at the end of curves
};

/// Makes creases of the sharp edges that form clean curves, and finds their corners (`ShapeMarks::corners`): vertices
/// at which a boundary or crease continues but turns sharply. Noise, that is single sharp edges and jagged rows, stays
/// smooth; if most sharp edges are noise, all stay smooth.
///
/// `is_hard` [E], unless empty: edges that are sharp at any angle, as the original's normals are split there. If most
/// sharp edges are hard, the others are not sharp. The mesh must be manifold, with edges. O(F).
void mark_sharp_curves(Mesh& mesh, const std::vector<bool>& is_hard = {});

/// Returns [V] the roles of the vertices. `seams`: further edges that count as curves, in ascending order.
[[nodiscard]] std::vector<CurveRole> curve_roles(const Topology& topology, const std::vector<uint32_t>& seams = {});

}  // namespace papilio
