#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// What a vertex is to the curves of a surface: its boundaries and creases.
enum class CurveRole : uint8_t {
  smooth,  ///< inside a smooth part
  inner,   ///< a curve goes through it
  corner,  ///< curves end there
};

/// Makes creases of the sharp edges that form clean curves, and finds their corners (`ShapeMarks::corners`: where a
/// boundary or crease goes on but turns sharply). Sharp edges that are noise, single ones and jagged rows, stay smooth;
/// where most are, all do. `is_hard` [E], unless empty: edges that are sharp whatever their angle, as the original's
/// normals are split there. If most sharp edges are hard, the others are not sharp. The mesh must be manifold, with its
/// edges. O(F).
void mark_sharp_curves(Mesh& mesh, const std::vector<bool>& is_hard = {});

/// Roles of the vertices [V]. `seams`: edges that are curves, too, in ascending order.
[[nodiscard]] std::vector<CurveRole> curve_roles(const Topology& topology, const std::vector<uint32_t>& seams = {});

}  // namespace papilio
