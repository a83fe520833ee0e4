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

/// Vectors at the vertices of a level, split by the rules that hold for its positions: moved by them, a level has new
/// vertices that are moved by what split() makes of them. That is exact but for limits (tensed_rules.h): where one
/// shortens the way of a vertex from the middle of its edge, the vector is shortened by the same share.
class ButterflyOfVectors {
 public:
  /// `positions` [V] or more. The others, and they, are as in butterfly(), and must outlive this.
  ButterflyOfVectors(const Topology& topology, const Vec3f* positions, const SplitPlan& plan, double w,
                     const TensionField* tension);

  /// `vectors` [V]. Returns [plan.count()]. A vector that is not a number makes all those that depend on it one.
  [[nodiscard]] Buffer<Vec3d> split(const Buffer<Vec3d>& vectors) const;

 private:
  const Topology& topology_;
  const SplitPlan& plan_;
  double w_;
  const TensionField* tension_;
  Buffer<Vec3d> places_;
  Buffer<double> shares_;  ///< [plan.count()] that limits leave; empty without tension
};

}  // namespace papilio
