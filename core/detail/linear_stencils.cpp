#include "detail/linear_stencils.h"

#include <algorithm>
#include <map>

#include "mesh/curve.h"
#include "mesh/fan.h"
#include "rules/features.h"
#include "rules/stencil.h"

namespace papilio {
namespace {

/// Explicit rules of a vertex take the square of its valence.
constexpr uint32_t most_explicit_valence = 256;

class Builder {
 public:
  explicit Builder(const Topology& level)
      : level_(level), curves_(level), valence_(level.vertex_count, 0), is_on_curve_(level.vertex_count) {
    for (uint32_t h = 0; h < level.half_edge_count(); ++h) {
      ++valence_[level.origin[h]];
      if (level.is_curve(h)) is_on_curve_[level.origin[h]] = is_on_curve_[level.tip(h)] = true;
    }
    for (const uint32_t v : level.darts) is_on_curve_[v] = true;
  }

  LinearStencils build() {
    made_.first.reserve(size_t{level_.edge_count()} + 1);
    made_.first.push_back(0);
    for (const uint32_t h : level_.half_edge) {
      add_edge(h);
      made_.first.push_back(static_cast<uint32_t>(made_.vertex.size()));
    }
    return std::move(made_);
  }

 private:
  void add(uint32_t vertex, double weight) {
    made_.vertex.push_back(vertex);
    made_.weight.push_back(static_cast<float>(weight));
  }

  void add_edge(uint32_t h) {
    if (level_.is_curve(h)) return add_along_curve(h);
    const uint32_t t = level_.twin[h];
    const bool a = is_regular_at(h);
    const bool b = is_regular_at(t);
    if (a && b) return add_regular(h, t);
    const double share = a || b ? 1 : 0.5;
    if (!a) add_spoke(h, share);
    if (!b) add_spoke(t, share);
  }

  /// Returns whether the origin of h has the regular rules in the fan of h.
  [[nodiscard]] bool is_regular_at(uint32_t h) {
    const uint32_t v = level_.origin[h];
    if (!is_on_curve_[v]) return valence_[v] == stencil::regular_valence;
    collect_fan(level_, h, fan_);
    return is_regular(level_, fan_);
  }

  void add_along_curve(uint32_t h) {
    const uint32_t a = level_.origin[h];
    const uint32_t b = level_.tip(h);
    using Row = stencil::Curve<double>;
    add(a, Row::end);
    add(b, Row::end);
    const auto add_beyond = [&](uint32_t vertex, uint32_t end, uint32_t other) {
      if (vertex != none) return add(vertex, Row::next);
      add(end, 2 * Row::next);  // straight continuation of the curve
      add(other, -Row::next);
    };
    add_beyond(curves_.before(h), a, b);
    add_beyond(curves_.after(h), b, a);
  }

  void add_regular(uint32_t h, uint32_t t) {
    const bool a_left = level_.is_curve(Topology::previous(h));
    const bool b_left = level_.is_curve(Topology::next(h));
    const bool a_right = level_.is_curve(Topology::next(t));
    const bool b_right = level_.is_curve(Topology::previous(t));
    const bool a = a_left || a_right;
    const bool b = b_left || b_right;
    if (!a && !b) return add_eight_points(h, t);
    if (!a) return b_left ? add_interior_curve_left(h, t) : add_interior_curve_right(h, t);
    if (!b) return a_right ? add_interior_curve_left(t, h) : add_interior_curve_right(t, h);
    if (a_left && b_left) return add_curve_curve(h, t);
    if (a_right && b_right) return add_curve_curve(t, h);
    add_middle(h, 1);
  }

  void add_middle(uint32_t h, double share) {
    add(level_.origin[h], share / 2);
    add(level_.tip(h), share / 2);
  }
  /// Returns the vertex opposite to h in the face beyond h's edge.
  [[nodiscard]] uint32_t wing(uint32_t h) const { return level_.apex(level_.twin[h]); }

  void add_eight_points(uint32_t h, uint32_t t) {
    const stencil::Regular<double> row;
    add(level_.origin[h], row.end);
    add(level_.origin[t], row.end);
    for (const uint32_t side : {h, t}) {
      add(level_.apex(side), row.apex);
      add(wing(Topology::next(side)), row.wing);
      add(wing(Topology::previous(side)), row.wing);
    }
  }

  /// Adds the rule of an edge from the interior to a curve that runs along the left face.
  void add_interior_curve_left(uint32_t h, uint32_t t) {
    add_interior_curve(h, {level_.apex(h), level_.apex(t), wing(Topology::previous(h)), wing(Topology::next(t)),
                           wing(Topology::previous(t))});
  }
  /// Adds the rule of an edge from the interior to a curve that runs along the right face.
  void add_interior_curve_right(uint32_t h, uint32_t t) {
    add_interior_curve(h, {level_.apex(t), level_.apex(h), wing(Topology::next(t)), wing(Topology::previous(h)),
                           wing(Topology::next(h))});
  }
  struct InteriorCurvePoints {
    uint32_t p, q, wing_ap, wing_aq, b_next;
  };
  void add_interior_curve(uint32_t h, const InteriorCurvePoints& points) {
    using Row = stencil::InteriorCurve<double>;
    add(level_.origin[h], Row::a);
    add(level_.tip(h), Row::b);
    add(points.p, Row::p);
    add(points.q, Row::q);
    add(points.b_next, Row::b_next);
    add(points.wing_ap, Row::wing_ap);
    add(points.wing_aq, Row::wing_aq);
  }

  /// Adds the rule of an edge with curves along both other edges of the left face.
  void add_curve_curve(uint32_t h, uint32_t t) {
    using Row = stencil::CurveCurve<double>;
    add_middle(h, 2 * Row::end);
    add(level_.apex(t), Row::apex);
    add(wing(Topology::next(t)), Row::wing);
    add(wing(Topology::previous(t)), Row::wing);
  }

  /// Adds the rule of the origin of h, which is irregular.
  void add_spoke(uint32_t h, double share) {
    if (valence_[level_.origin[h]] > most_explicit_valence) return add_middle(h, share);
    collect_fan(level_, h, fan_);
    if (fan_.closed)
      add_interior(share);
    else if (is_corner(level_, fan_.centre))
      add_middle(h, share);
    else
      add_curve_spoke(h, share);
  }

  /// Adds the rule of an irregular origin of h with an open fan.
  void add_curve_spoke(uint32_t h, double share) {
    const uint32_t triangles = fan_.valence();
    const stencil::CurveRule rule(triangles);
    const auto spoke = static_cast<uint32_t>(std::ranges::find(fan_.spokes, h) - fan_.spokes.begin());
    const stencil::CurveSpoke row = rule.spoke(spoke);
    add(fan_.centre, share * row.centre);
    add(fan_.ring.front(), share * row.end);
    add(fan_.ring.back(), -share * row.end);
    for (uint32_t j = 1; j < triangles; ++j)
      add(fan_.ring[j], share * (row.sine_1 * rule.sine(j) + row.sine_2 * rule.sine(2 * j)));
  }

  void add_interior(double share) {
    const stencil::Interior& row = interior(fan_.valence());
    add(fan_.centre, share * row.centre);
    for (uint32_t j = 0; j < fan_.valence(); ++j) add(fan_.ring[j], share * row.ring[j]);
  }

  const stencil::Interior& interior(uint32_t valence) {
    auto [found, is_new] = interiors_.try_emplace(valence);
    if (is_new) found->second = stencil::interior(valence);
    return found->second;
  }

  const Topology& level_;
  CurveNeighbours curves_;
  std::vector<uint32_t> valence_;
  std::vector<bool> is_on_curve_;  // [V] on a curve, where the rule depends on more than the valence
  std::map<uint32_t, stencil::Interior> interiors_;
  Fan fan_;
  LinearStencils made_;
};

}  // namespace

LinearStencils linear_stencils(const Topology& level) { return Builder(level).build(); }

}  // namespace papilio
