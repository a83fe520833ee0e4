#pragma once

#include "mesh/marks.h"
#include "papilio/mesh.h"
#include "rules/features.h"
#include "rules/tension.h"

namespace papilio {

/// Variants of the Modified Butterfly scheme.
template <class Real>
struct ButterflyOptions {
  Real w = 0;                             ///< free parameter of the ten-point rule; 0: eight points
  const TensionField* tension = nullptr;  ///< field of the level; null: the plain scheme
  const Marks* complete = nullptr;  ///< [E] with w: edges whose stencils are held, none at a vertex at a cut; null: all
  int threads = 1;                  ///< upper bound of the number of threads
};

/// Computes the new vertices of all edges of a level by the Modified Butterfly scheme (weights and sources: stencil.h).
/// Writes them to `made` [E]; values at edges that touch a vertex at a cut are undefined.
///
/// `features` are those of the level, `positions` [V] its vertices. Both arrays must be in a `Buffer` (vec3fa.h). Each
/// result depends on its stencil alone, to the bit, not on which half-edge stands for the edge. From
/// `stencil::harmonic_valence` on, it also depends on which half-edge of the ring has the lowest number. O(F +
/// total valence). Instantiated for float (the product) and double (morph targets, and checking the arithmetic).
template <class Real>
void butterfly(const Topology& topology, const Features& features, const Vec3T<Real>* positions, Vec3T<Real>* made,
               const ButterflyOptions<Real>& options = {});

/// Splits vectors at the vertices of a level by the rules that hold for its positions. If vectors move the vertices,
/// the results of split() move the new vertices. This is exact except for limits (tensed_rules.h): where a limit
/// shortens a vertex's offset from the midpoint, the vector is shortened by an equal share.
class ButterflyOfVectors {
 public:
  /// `positions` has at least V entries. The topology and the data of the options must outlive this object.
  ButterflyOfVectors(const Topology& topology, const Vec3f* positions, const ButterflyOptions<double>& options);

  /// Returns the vectors at the new vertices [E], given `vectors` [V]. A NaN makes all vectors that depend on it NaN.
  [[nodiscard]] Buffer<Vec3d> split(const Buffer<Vec3d>& vectors) const;

 private:
  const Topology& topology_;
  Features features_;
  ButterflyOptions<double> options_;
  Buffer<Vec3d> places_;
  Buffer<double> shares_;  ///< [E] share of the offset that limits leave; empty without tension
};

}  // namespace papilio
