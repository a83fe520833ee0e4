#pragma once

#include <vector>

#include "features.h"
#include "mesh.h"
#include "split_plan.h"
#include "tension.h"

namespace papilio {

/// Positions of the new vertices of all target edges, by the Modified Butterfly scheme (weights and sources:
/// stencil.h).
///
/// `positions` [V] are those of the level, `w` is the free parameter of the ten-point rule (0: eight points), `tension`
/// the level's field (null: the plain scheme). Edges of the plan must not touch a vertex at a cut.
/// Returns [plan.count()], in the plan's order. Each result depends on its stencil alone, to the bit: not on
/// what else is a target, nor on which half-edge stands for the edge (from `stencil::harmonic_valence` on,
/// also on which half-edge of the ring has the lowest number). O(F + total valence). Instantiated for float
/// (the product) and double (checking the arithmetic).
template <class Real>
[[nodiscard]] Array<Vec3T<Real>> butterfly(const Topology& topology, const Array<Vec3T<Real>>& positions,
                                           const SplitPlan& plan, Real w = 0, const TensionField* tension = nullptr);

/// The same, to the bit, where every edge is split and w is 0: writes the new vertex of each edge to `made` [E].
/// `positions` [V] are an `Array`'s (lanes.h); `features` are those of the level. Up to so many threads work on it.
/// O(F), and several times as fast.
void uniform_butterfly(const Topology& topology, const Features& features, const Vec3f* positions, Vec3f* made,
                       const TensionField* tension = nullptr, int threads = 1);

}  // namespace papilio
