#pragma once

#include "mesh/split_plan.h"
#include "papilio/mesh.h"
#include "rules/tension.h"

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
[[nodiscard]] Buffer<Vec3T<Real>> butterfly(const Topology& topology, const Buffer<Vec3T<Real>>& positions,
                                            const SplitPlan& plan, Real w = 0, const TensionField* tension = nullptr);

}  // namespace papilio
