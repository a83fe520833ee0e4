#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/trigonometry.h"
#include "mesh/curve.h"
#include "mesh/fan.h"
#include "rules/edge_accumulator.h"
#include "rules/stencil.h"
#include "rules/tensed_rules.h"
#include "rules/tension.h"
#include "simd/vec3fa.h"

namespace papilio {

/// Weights of irregular interior vertices, converted once.
template <class Real>
class InteriorWeights {
 public:
  explicit InteriorWeights() {
    for (uint32_t k = 2; k < stencil::harmonic_valence; ++k) {
      const stencil::Interior exact = stencil::interior(k);
      centre_[k] = static_cast<Real>(exact.centre);
      for (uint32_t j = 0; j < k; ++j) ring_[k][j] = static_cast<Real>(exact.ring[j]);
    }
  }
  [[nodiscard]] Real centre(uint32_t valence) const { return centre_[valence]; }
  [[nodiscard]] const Real* ring(uint32_t valence) const { return ring_[valence].data(); }

 private:
  std::array<Real, stencil::harmonic_valence> centre_{};
  std::array<std::array<Real, stencil::harmonic_valence>, stencil::harmonic_valence> ring_{};
};

template <class Real>
inline const InteriorWeights<Real> interior_weights;

/// Points of the rule for an irregular closed fan: its centre and its ring, the vertices ring(0), ring(1), .. The
/// valence is below `stencil::harmonic_valence`; a valence known at compile time is faster.
template <class Real, uint32_t known_valence = 0>
class InteriorRing {
 public:
  template <class Ring>
  InteriorRing(const Vec3T<Real>* positions, VertexId centre, uint32_t valence, const Ring& ring)
      : valence_(valence),
        weights_(interior_weights<Real>.ring(valence)),
        centre_(interior_weights<Real>.centre(valence) * widen(positions[centre])) {
    for (uint32_t j = 0; j < this->valence(); ++j)
      points_[j] = points_[this->valence() + j] = widen(positions[ring(j)]);
  }
  [[nodiscard]] Vec3T<Real> split(HalfEdgeId spoke) const {
    Wide<Real> sum = centre_;
    for (uint32_t j = 0; j < valence(); ++j) sum += weights_[j] * points_[spoke + j];
    Vec3T<Real> q;
    store(sum, q);
    return q;
  }

 private:
  [[nodiscard]] uint32_t valence() const { return known_valence != 0 ? known_valence : valence_; }

  uint32_t valence_;
  const Real* weights_;
  Wide<Real> centre_;
  std::array<Wide<Real>, size_t{2} * (known_valence != 0 ? known_valence : stencil::harmonic_valence)> points_;
};

/// Computes a closed fan's contributions to all its spokes, without tension: calls add(j, position) for spoke j.
/// Arguments: see InteriorRing.
template <class Real, class Ring, class Add>
void split_ring(const Vec3T<Real>* positions, VertexId centre, uint32_t valence, const Ring& ring, const Add& add) {
  const auto split = [&]<uint32_t known_valence>(std::integral_constant<uint32_t, known_valence> /*of*/) {
    const InteriorRing<Real, known_valence> points(positions, centre, valence, ring);
    for (uint32_t i = 0; i < (known_valence != 0 ? known_valence : valence); ++i) add(i, points.split(i));
  };
#if defined(__wasm__)  // where code size has priority
  split(std::integral_constant<uint32_t, 0>());
#else
  switch (valence) {
    case 3:
      return split(std::integral_constant<uint32_t, 3>());
    case 4:
      return split(std::integral_constant<uint32_t, 4>());
    case 5:
      return split(std::integral_constant<uint32_t, 5>());
    case 7:
      return split(std::integral_constant<uint32_t, 7>());
    case 8:
      return split(std::integral_constant<uint32_t, 8>());
    case 9:
      return split(std::integral_constant<uint32_t, 9>());
    default:
      return split(std::integral_constant<uint32_t, 0>());
  }
#endif
}

/// Rules of one level for the new vertex of an edge, given the positions round it. For which rule holds where, see
/// butterfly.h. Each result depends on its stencil alone, to the bit: sums are of symmetric pairs, so both half-edges
/// of an edge give equal results.
template <class Real>
class ButterflyRules {
  using Point = Vec3T<Real>;

 public:
  /// Applies the rules that hold at `places` [V] to `points` [V]. All arguments must outlive this object; `tension` may
  /// be null.
  ButterflyRules(const Topology& topology, const Point* places, const Point* points, Real w,
                 const TensionField* tension)
      : mesh_(topology), place_(places), p_(points), w_(w), share_(w) {
    if (tension != nullptr) tensed_.emplace(topology, places, points, *tension);
  }

  /// Computes an irregular fan's contributions to its spokes inside the surface: calls add(spoke, position).
  template <class Add>
  void split_spokes(const Fan& fan, const Add& add) const {
    if (fan.closed && fan.valence() < stencil::harmonic_valence)
      split_interior_spokes(fan, add);
    else if (fan.closed)
      split_interior_spokes_by_harmonics(fan, add);
    else
      split_curve_spokes(fan, add);
  }

  /// Returns whether all hinge factors of a closed fan are 1, so that its rule is the plain one. True without tension.
  template <class Spokes, class EdgeOf>
  [[nodiscard]] bool are_whole(const Spokes& spokes, const EdgeOf& edge_of) const {
    return !tensed_ ||
           std::ranges::all_of(spokes, [&](const auto& spoke) { return tensed_->is_whole(edge_of(spoke)); });
  }

  [[nodiscard]] Point along_curve(const CurveNeighbours& curves, EdgeId e) const {
    const HalfEdgeId h = mesh_.half_edge[e];
    const auto along = [&](const Point* points) {
      const Point a = points[mesh_.origin[h]];
      const Point b = points[mesh_.tip(h)];
      const auto beyond = [&](VertexId vertex, Point end, Point other) {
        return vertex == none ? Real(2) * end - other : points[vertex];
      };
      return std::array<Point, 4>{beyond(curves.before(h), a, b), a, b, beyond(curves.after(h), b, a)};
    };
    const auto points = along(p_);
    if (tensed_) return tensed_->along_curve(points, place_ == p_ ? points : along(place_));
    const auto& [before, a, b, after] = points;
    return stencil::Curve<Real>::end * (a + b) + stencil::Curve<Real>::next * (before + after);
  }

  /// Returns the new vertex of an edge with both ends regular. The row depends on the sides on which a
  /// curve touches them.
  [[nodiscard]] Point regular(HalfEdgeId h) const {
    const HalfEdgeId t = mesh_.twin[h];
    if (!tensed_) return regular(h, t);
    if (touches_curve(h, t)) return tensed_->scaled(h, regular(h, t));
    const Point q = tensed_->interior_interior(h, t);
    return w_ == 0 ? q : q + tensed_->least_factor(h) * (interior_interior(h, t) - eight_points(h, t));
  }

  /// Applies the final steps of every rule: follow(), then limit(). `h` is the edge's half-edge; `curves` may be null
  /// where there are none.
  [[nodiscard, gnu::always_inline]] Point finish(HalfEdgeId h, Point q, const CurveNeighbours* curves) const {
    return limit(h, follow(h, q, curves));
  }
  /// Applies the rules for strips and sharp edges, which are linear in the points.
  [[nodiscard]] Point follow(HalfEdgeId h, Point q, const CurveNeighbours* curves) const {
    if (!tensed_) return q;
    if (curves != nullptr && tensed_->is_diagonal_of_strip(h)) q = across_strip(*curves, h);
    return tensed_->followed(h, q);
  }
  [[nodiscard]] Point middle(HalfEdgeId h) const { return Real(0.5) * (at(mesh_.origin[h]) + at(mesh_.tip(h))); }
  /// Applies the limits of tension and shape rules. For places only.
  [[nodiscard, gnu::always_inline]] Point limit(HalfEdgeId h, Point q) const {
    return tensed_ ? tensed_->limited(h, q) : q;
  }

  /// Adds the contributions of face f to its three edges, by the eight-point rule where every edge is split. The face
  /// must have a twin at each side. Contributions of two faces add up to `regular`, to the bit. `shares`: see
  /// edge_accumulator.h.
  template <class Shares>
  void add_face_shares(FaceId f, Shares& shares) const {
    const uint32_t* corner = &mesh_.origin[size_t{3} * f];
    const uint32_t* twin = &mesh_.twin[size_t{3} * f];
    const uint32_t* edge = &mesh_.edge[size_t{3} * f];
    const std::array<Wide<Real>, 3> p{wide(corner[0]), wide(corner[1]), wide(corner[2])};
    const std::array<Wide<Real>, 3> wing{wide(mesh_.apex(twin[0])), wide(mesh_.apex(twin[1])),
                                         wide(mesh_.apex(twin[2]))};
    if (tensed_) {
      tensed_->add_face_shares(f, p, wing, shares);
      return;
    }
    shares.add(f, twin[0], edge[0], share_(p[0], p[1], p[2], wing[1], wing[2]));
    shares.add(f, twin[1], edge[1], share_(p[1], p[2], p[0], wing[2], wing[0]));
    shares.add(f, twin[2], edge[2], share_(p[2], p[0], p[1], wing[0], wing[1]));
  }

 private:
  template <class Add>
  void split_interior_spokes(const Fan& fan, const Add& add) const {
    const uint32_t k = fan.valence();
    const InteriorRing<Real> points(p_, fan.centre, k, [&](uint32_t j) { return fan.ring[j]; });
    const Real* s = interior_weights<Real>.ring(k);
    const bool is_plain = k == 2 || are_whole(fan.spokes, [&](HalfEdgeId spoke) { return mesh_.edge[spoke]; });
    for (uint32_t i = 0; i < k; ++i)
      add(fan.spokes[i], is_plain ? points.split(i) : tensed_->interior_spoke(fan, s, i));
  }

  template <class Add>
  void split_interior_spokes_by_harmonics(const Fan& fan, const Add& add) const {
    const uint32_t k = fan.valence();
    const std::vector<SineCosine> angles = sines_and_cosines_of_turn(k, k);
    const auto twice = [&](uint32_t j) { return angles[2 * j < k ? 2 * j : 2 * j - k]; };
    Vec3d sum, c1, s1, c2, s2;
    for (uint32_t j = 0; j < k; ++j) {
      const Vec3d p = to_double(p_[fan.ring[j]]);
      sum += p;
      c1 += angles[j].cosine * p;
      s1 += angles[j].sine * p;
      c2 += twice(j).cosine * p;
      s2 += twice(j).sine * p;
    }
    const Vec3d constant = stencil::interior_centre * to_double(p_[fan.centre]) + (stencil::harmonic_0 / k) * sum;
    const Real factor = tensed_ ? tensed_->least_factor(fan) : Real(1);
    for (uint32_t i = 0; i < k; ++i) {
      const Vec3d first = angles[i].cosine * c1 + angles[i].sine * s1;
      const Vec3d second = twice(i).cosine * c2 + twice(i).sine * s2;
      const Point q = narrow(constant + (stencil::harmonic_1 / k) * first + (stencil::harmonic_2 / k) * second);
      add(fan.spokes[i], tensed_ ? tensed_->scaled(fan.spokes[i], q, factor) : q);
    }
  }

  template <class Add>
  void split_curve_spokes(const Fan& fan, const Add& add) const {
    const uint32_t k = fan.valence();
    if (k < 2) return;  // no spoke lies inside
    if (is_corner(mesh_, fan.centre)) {
      for (uint32_t i = 1; i < k; ++i) add(fan.spokes[i], Real(0.5) * (p_[fan.centre] + p_[fan.ring[i]]));
      return;
    }
    const stencil::CurveRule rules(k);
    Vec3d sum_1, sum_2;
    for (uint32_t j = 1; j < k; ++j) {
      const Vec3d p = to_double(p_[fan.ring[j]]);
      sum_1 += rules.sine(j) * p;
      sum_2 += rules.sine(2 * j) * p;
    }
    const Vec3d across = to_double(p_[fan.ring[0]]) - to_double(p_[fan.ring[k]]);
    for (uint32_t i = 1; i < k; ++i) {
      const stencil::CurveSpoke rule = rules.spoke(i);
      const Point q = narrow(rule.centre * to_double(p_[fan.centre]) + rule.end * across + rule.sine_1 * sum_1 +
                             rule.sine_2 * sum_2);
      add(fan.spokes[i], tensed_ ? tensed_->scaled(fan.spokes[i], q) : q);
    }
  }

  [[nodiscard]] bool touches_curve(HalfEdgeId h, HalfEdgeId t) const {
    return mesh_.is_curve(h.previous()) || mesh_.is_curve(h.next()) || mesh_.is_curve(t.next()) ||
           mesh_.is_curve(t.previous());
  }

  [[nodiscard]] Point regular(HalfEdgeId h, HalfEdgeId t) const {
    const bool a_left = mesh_.is_curve(h.previous());
    const bool b_left = mesh_.is_curve(h.next());
    const bool a_right = mesh_.is_curve(t.next());
    const bool b_right = mesh_.is_curve(t.previous());
    const bool a_curve = a_left || a_right;
    const bool b_curve = b_left || b_right;
    if (!a_curve && !b_curve) return interior_interior(h, t);
    if (!a_curve) return b_left ? interior_curve_left(h, t) : interior_curve_right(h, t);
    // The edge reversed lies between the same two vertices with its sides swapped.
    if (!b_curve) return a_right ? interior_curve_left(t, h) : interior_curve_right(t, h);
    if (a_left && b_left) return curve_curve(h, t);
    if (a_right && b_right) return curve_curve(t, h);
    return Real(0.5) * (p_[mesh_.origin[h]] + p_[mesh_.origin[t]]);
  }

  /// Moves the diagonal of a flat quadrangle between two curves by half the sum of their moves. So the wall of a drum
  /// is as round as its rims. (The published rule is the midpoint, which leaves the wall faceted.)
  [[nodiscard]] Point across_strip(const CurveNeighbours& curves, HalfEdgeId h) const {
    const auto [one, other] = sides_of_strip(mesh_, h);
    const auto moved = [&](uint32_t side) { return along_curve(curves, mesh_.edge[side]) - middle(side); };
    return middle(h) + Real(0.5) * (moved(one) + moved(other));
  }

  /// Returns the vertex across the edge of h from h's face.
  [[nodiscard]] Point wing(HalfEdgeId h) const { return p_[mesh_.apex(mesh_.twin[h])]; }
  [[nodiscard]] Point at(VertexId vertex) const { return p_[vertex]; }

  [[nodiscard]] Point interior_interior(HalfEdgeId h, HalfEdgeId t) const {
    const Point q = eight_points(h, t, share_);
    return w_ == 0 ? q : q + share_.far * (far_point(h) + far_point(t));
  }
  [[nodiscard]] Point eight_points(HalfEdgeId h, HalfEdgeId t,
                                   const stencil::FaceShare<Real>& share = stencil::FaceShare<Real>()) const {
    return face_share(h, t, share) + face_share(t, h, share);
  }
  [[nodiscard]] Point face_share(HalfEdgeId h, HalfEdgeId t, const stencil::FaceShare<Real>& share) const {
    return share(at(mesh_.origin[h]), at(mesh_.origin[t]), at(mesh_.apex(h)), wing(h.next()), wing(h.previous()));
  }

  /// Returns the vertex opposite to h's tip in the ring of its (regular) origin.
  [[nodiscard]] Point far_point(HalfEdgeId h) const {
    for (int step = 0; step < 3; ++step) h = mesh_.twin[h.previous()];
    return at(mesh_.tip(h));
  }

  /// Applies the row for A = origin(h) interior and B on a curve that runs along the left face.
  [[nodiscard]] Point interior_curve_left(HalfEdgeId h, HalfEdgeId t) const {
    return interior_curve(h, mesh_.apex(h), mesh_.apex(t), wing(h.previous()), wing(t.next()), wing(t.previous()));
  }
  /// Applies the row for A = origin(h) interior and B on a curve that runs along the right face.
  [[nodiscard]] Point interior_curve_right(HalfEdgeId h, HalfEdgeId t) const {
    return interior_curve(h, mesh_.apex(t), mesh_.apex(h), wing(t.next()), wing(h.previous()), wing(h.next()));
  }
  [[nodiscard]] Point interior_curve(HalfEdgeId h, uint32_t p, uint32_t q, Point wing_ap, Point wing_aq,
                                     Point b_next) const {
    using Row = stencil::InteriorCurve<Real>;
    return Row::a * at(mesh_.origin[h]) + Row::b * at(mesh_.tip(h)) + Row::p * at(p) + Row::q * at(q) +
           Row::b_next * b_next + Row::wing_ap * wing_ap + Row::wing_aq * wing_aq;
  }

  /// Applies the row for curves along both edges of the left face; the stencil lies on the right.
  [[nodiscard]] Point curve_curve(HalfEdgeId h, HalfEdgeId t) const {
    using Row = stencil::CurveCurve<Real>;
    return Row::end * (at(mesh_.origin[h]) + at(mesh_.origin[t])) + Row::apex * at(mesh_.apex(t)) +
           Row::wing * (wing(t.next()) + wing(t.previous()));
  }

  [[nodiscard]] Wide<Real> wide(VertexId vertex) const { return widen(p_[vertex]); }
  static Point narrow(Vec3d p) { return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)}; }

  const Topology& mesh_;
  const Point *place_, *p_;
  Real w_;
  stencil::FaceShare<Real> share_;
  std::optional<TensedRules<Real>> tensed_;
};

}  // namespace papilio
