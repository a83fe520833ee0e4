#include "butterfly.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "curve.h"
#include "fan.h"
#include "stencil.h"
#include "tensed_rules.h"

namespace papilio {
namespace {

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
class Butterfly {
  using Point = Vec3T<Real>;

 public:
  Butterfly(const Topology& topology, const Array<Point>& positions, const SplitPlan& plan, Real w,
            const TensionField* tension)
      : mesh_(topology),
        p_(positions),
        plan_(plan),
        w_(w),
        regular_(w),
        out_(plan.count()),
        irregular_ends_(plan.count(), 0) {
    if (tension != nullptr) tensed_.emplace(topology, positions, *tension);
  }

  Array<Point> run() {
    split_at_irregular_vertices();
    const CurveNeighbours curves(mesh_);
    for (uint32_t e = 0; e < mesh_.edge_count(); ++e) {
      if (!plan_.is_split(e)) continue;
      const uint32_t rank = plan_.before[e];
      if (mesh_.kind[e] != EdgeKind::smooth)
        out_[rank] = along_curve(curves, e);
      else if (irregular_ends_[rank] == 2)
        out_[rank] = Real(0.5) * out_[rank];
      else if (irregular_ends_[rank] == 0)
        out_[rank] = regular(mesh_.half_edge[e]);
      if (tensed_) out_[rank] = tensed_->finish(mesh_.half_edge[e], out_[rank]);
    }
    return std::move(out_);
  }

 private:
  // Irregular vertices go first, fan by fan: each adds its own opinion to its spokes, so that a ring is
  // walked once however large it is. An edge with two irregular ends takes the mean of the two.
  void split_at_irregular_vertices() {
    Fan fan;
    for_each_irregular_fan(mesh_, fan, [&] {
      if (fan.closed && fan.valence() < stencil::harmonic_valence)
        split_interior_spokes(fan);
      else if (fan.closed)
        split_interior_spokes_by_harmonics(fan);
      else
        split_curve_spokes(fan);
    });
  }

  void add_opinion(uint32_t spoke, Point q) {
    const uint32_t e = mesh_.edge[spoke];
    if (!plan_.is_split(e)) return;
    const uint32_t rank = plan_.before[e];
    out_[rank] = irregular_ends_[rank]++ == 0 ? q : out_[rank] + q;
  }

  void split_interior_spokes(const Fan& fan) {
    static const InteriorWeights<Real> weights;
    const uint32_t k = fan.valence();
    const Real* s = weights.ring(k);
    for (uint32_t i = 0; i < k; ++i) {
      if (!plan_.is_split(mesh_.edge[fan.spokes[i]])) continue;
      if (tensed_ && k > 2) {
        add_opinion(fan.spokes[i], tensed_->interior_spoke(fan, s, i));
        continue;
      }
      Point q = weights.centre(k) * p_[fan.centre];
      for (uint32_t j = 0; j < k; ++j) q += s[j] * p_[fan.ring[i + j < k ? i + j : i + j - k]];
      add_opinion(fan.spokes[i], q);
    }
  }

  void split_interior_spokes_by_harmonics(const Fan& fan) {
    const uint32_t k = fan.valence();
    const auto angle = [&](uint32_t j) { return 2 * std::numbers::pi * j / k; };
    Vec3d sum, c1, s1, c2, s2;
    for (uint32_t j = 0; j < k; ++j) {
      const Vec3d p = widen(p_[fan.ring[j]]);
      sum += p;
      c1 += std::cos(angle(j)) * p;
      s1 += std::sin(angle(j)) * p;
      c2 += std::cos(2 * angle(j)) * p;
      s2 += std::sin(2 * angle(j)) * p;
    }
    const Vec3d constant = stencil::interior_centre * widen(p_[fan.centre]) + (stencil::harmonic_0 / k) * sum;
    const Real factor = tensed_ ? tensed_->least_factor(fan) : Real(1);
    for (uint32_t i = 0; i < k; ++i) {
      const Vec3d first = std::cos(angle(i)) * c1 + std::sin(angle(i)) * s1;
      const Vec3d second = std::cos(2 * angle(i)) * c2 + std::sin(2 * angle(i)) * s2;
      const Point q = narrow(constant + (stencil::harmonic_1 / k) * first + (stencil::harmonic_2 / k) * second);
      add_opinion(fan.spokes[i], tensed_ ? tensed_->scaled(fan.spokes[i], q, factor) : q);
    }
  }

  void split_curve_spokes(const Fan& fan) {
    const uint32_t k = fan.valence();
    const double theta = std::numbers::pi / k;
    Vec3d sum_1, sum_2;
    for (uint32_t j = 1; j < k; ++j) {
      const Vec3d p = widen(p_[fan.ring[j]]);
      sum_1 += std::sin(j * theta) * p;
      sum_2 += std::sin(2 * j * theta) * p;
    }
    const Vec3d across = widen(p_[fan.ring[0]]) - widen(p_[fan.ring[k]]);
    for (uint32_t i = 1; i < k; ++i) {
      const stencil::CurveSpoke rule = stencil::curve_spoke(k, i);
      const Point q =
          narrow(rule.centre * widen(p_[fan.centre]) + rule.end * across + rule.sine_1 * sum_1 + rule.sine_2 * sum_2);
      add_opinion(fan.spokes[i], tensed_ ? tensed_->scaled(fan.spokes[i], q) : q);
    }
  }

  // The rules below are sums of symmetric pairs, so that both half-edges of an edge give the same bits.

  [[nodiscard]] Point along_curve(const CurveNeighbours& curves, uint32_t e) const {
    const uint32_t h = mesh_.half_edge[e];
    const Point a = p_[mesh_.origin[h]];
    const Point b = p_[mesh_.tip(h)];
    const auto beyond = [&](uint32_t vertex, Point end, Point other) {
      return vertex == none ? Real(2) * end - other : p_[vertex];
    };
    const Point before = beyond(curves.before(h), a, b);
    const Point after = beyond(curves.after(h), b, a);
    if (tensed_) return tensed_->along_curve(before, a, b, after);
    return stencil::Curve<Real>::end * (a + b) + stencil::Curve<Real>::next * (before + after);
  }

  /// Both ends regular: which row applies depends on the sides on which a curve touches them.
  [[nodiscard]] Point regular(uint32_t h) const {
    const uint32_t t = mesh_.twin[h];
    if (!tensed_) return regular(h, t);
    if (touches_curve(h, t)) return tensed_->scaled(h, regular(h, t));
    const Point q = tensed_->interior_interior(h, t);
    return w_ == 0 ? q : q + tensed_->least_factor(h) * (interior_interior(h, t) - eight_points(h, t));
  }

  [[nodiscard]] bool touches_curve(uint32_t h, uint32_t t) const {
    return mesh_.is_curve(Topology::previous(h)) || mesh_.is_curve(Topology::next(h)) ||
           mesh_.is_curve(Topology::next(t)) || mesh_.is_curve(Topology::previous(t));
  }

  [[nodiscard]] Point regular(uint32_t h, uint32_t t) const {
    const bool a_left = mesh_.is_curve(Topology::previous(h));
    const bool b_left = mesh_.is_curve(Topology::next(h));
    const bool a_right = mesh_.is_curve(Topology::next(t));
    const bool b_right = mesh_.is_curve(Topology::previous(t));
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

  /// The vertex across the edge of h from h's face.
  [[nodiscard]] Point wing(uint32_t h) const { return p_[mesh_.apex(mesh_.twin[h])]; }
  [[nodiscard]] Point at(uint32_t vertex) const { return p_[vertex]; }

  [[nodiscard]] Point interior_interior(uint32_t h, uint32_t t) const {
    const Point q = eight_points(h, t, regular_);
    return w_ == 0 ? q : q + regular_.far * (far_point(h) + far_point(t));
  }
  [[nodiscard]] Point eight_points(uint32_t h, uint32_t t,
                                   const stencil::Regular<Real>& row = stencil::Regular<Real>()) const {
    const Point ends = at(mesh_.origin[h]) + at(mesh_.origin[t]);
    const Point apexes = at(mesh_.apex(h)) + at(mesh_.apex(t));
    const Point wings_left = wing(Topology::next(h)) + wing(Topology::previous(h));
    const Point wings_right = wing(Topology::next(t)) + wing(Topology::previous(t));
    return row.end * ends + row.apex * apexes + row.wing * (wings_left + wings_right);
  }

  /// The vertex opposite to h's tip in the ring of its (regular) origin.
  [[nodiscard]] Point far_point(uint32_t h) const {
    for (int step = 0; step < 3; ++step) h = mesh_.twin[Topology::previous(h)];
    return at(mesh_.tip(h));
  }

  /// A = origin(h) interior, B on a curve that runs along the left face.
  [[nodiscard]] Point interior_curve_left(uint32_t h, uint32_t t) const {
    return interior_curve(h, mesh_.apex(h), mesh_.apex(t), wing(Topology::previous(h)), wing(Topology::next(t)),
                          wing(Topology::previous(t)));
  }
  /// The same with the curve along the right face.
  [[nodiscard]] Point interior_curve_right(uint32_t h, uint32_t t) const {
    return interior_curve(h, mesh_.apex(t), mesh_.apex(h), wing(Topology::next(t)), wing(Topology::previous(h)),
                          wing(Topology::next(h)));
  }
  [[nodiscard]] Point interior_curve(uint32_t h, uint32_t p, uint32_t q, Point wing_ap, Point wing_aq,
                                     Point b_next) const {
    using Row = stencil::InteriorCurve<Real>;
    return Row::a * at(mesh_.origin[h]) + Row::b * at(mesh_.tip(h)) + Row::p * at(p) + Row::q * at(q) +
           Row::b_next * b_next + Row::wing_ap * wing_ap + Row::wing_aq * wing_aq;
  }

  /// Curves along both edges of the left face; the stencil lies on the right.
  [[nodiscard]] Point curve_curve(uint32_t h, uint32_t t) const {
    using Row = stencil::CurveCurve<Real>;
    return Row::end * (at(mesh_.origin[h]) + at(mesh_.origin[t])) + Row::apex * at(mesh_.apex(t)) +
           Row::wing * (wing(Topology::next(t)) + wing(Topology::previous(t)));
  }

  static Vec3d widen(Point p) { return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)}; }
  static Point narrow(Vec3d p) { return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)}; }

  const Topology& mesh_;
  const Array<Point>& p_;
  const SplitPlan& plan_;
  Real w_;
  stencil::Regular<Real> regular_;
  Array<Point> out_;
  std::optional<TensedRules<Real>> tensed_;
  std::vector<uint8_t> irregular_ends_;  ///< [plan.count()] opinions already in `out_`: 0, 1 or 2
};

}  // namespace

template <class Real>
Array<Vec3T<Real>> butterfly(const Topology& topology, const Array<Vec3T<Real>>& positions,
                                   const SplitPlan& plan, Real w, const TensionField* tension) {
  return Butterfly<Real>(topology, positions, plan, w, tension).run();
}

template Array<Vec3f> butterfly(const Topology&, const Array<Vec3f>&, const SplitPlan&, float,
                                      const TensionField*);
template Array<Vec3d> butterfly(const Topology&, const Array<Vec3d>&, const SplitPlan&, double,
                                      const TensionField*);

}  // namespace papilio
