#pragma once

#include <numbers>

#include "tests/support/reference_surface.h"

namespace papilio::reference {

/// Modified Butterfly rules with tension: new vertices of the edges of a surface.
class Rules {
 public:
  Rules(const Surface& surface, const Options& options, Margin& margin)
      : s_(surface), at_(surface.at), options_(options), margin_(margin) {
    const bool has_tension = options.tension != Tension::off;
    for (uint32_t e = 0; e < s_.edges.size(); ++e)
      factor_.push_back(has_tension && s_.edges[e].kind == Kind::smooth ? hinge_factor(s_.cosine(e)) : 1);
  }

  [[nodiscard]] Vec3d new_vertex(uint32_t e) {
    const Vec3d q = s_.edges[e].kind == Kind::smooth ? inside(e) : along_curve(e);
    if (options_.tension == Tension::off) return q;
    const bool follows = options_.tension == Tension::sharp && factor_[e] < 1;
    const Vec3d off = (follows ? factor_[e] * q + (1 - factor_[e]) * along_feature(e) : q) - s_.middle(e);
    return s_.middle(e) + std::min(1.0, 0.2 * s_.length(e) / length(off)) * off;
  }

 private:
  /// Returns the tension factor of a hinge: 1 up to 60 degrees, 0 from 90 degrees on.
  static double hinge_factor(double cosine) {
    const double s = std::clamp(2 * cosine, 0.0, 1.0);
    return s * s * (3 - 2 * s);
  }

  Vec3d inside(uint32_t e) {
    const auto& [a, b, faces, kind] = s_.edges[e];
    const Fan of_a = s_.fan(a, faces[0]);
    const Fan of_b = s_.fan(b, faces[0]);
    margin_.is_disputed |= of_a.is_dart && (of_a.is_regular() || of_a.ring.size() < s_.edges_at[a].size());
    margin_.is_disputed |= of_b.is_dart && (of_b.is_regular() || of_b.ring.size() < s_.edges_at[b].size());
    if (!of_a.is_regular() && !of_b.is_regular()) return 0.5 * (irregular(e, a, of_a) + irregular(e, b, of_b));
    if (!of_a.is_regular()) return irregular(e, a, of_a);
    if (!of_b.is_regular()) return irregular(e, b, of_b);
    if (of_a.closed && of_b.closed) return ten_points(e, of_a, of_b);
    if (of_a.closed) return lessened(e, interior_to_curve(e, a, b, of_b));
    if (of_b.closed) return lessened(e, interior_to_curve(e, b, a, of_a));
    return lessened(e, curve_to_curve(e));
  }

  /// Applies the eight-point rule: the midpoint less four second differences over hinges. w adds the ten-point rule's
  /// difference from it.
  Vec3d ten_points(uint32_t e, const Fan& of_a, const Fan& of_b) const {
    const auto& [a, b, faces, kind] = s_.edges[e];
    const auto in_line = [&](const Fan& fan, uint32_t end) {
      return at_[fan.ring[(std::ranges::find(fan.ring, end) - fan.ring.begin() + 3) % 6]];
    };
    Vec3d q = s_.middle(e);
    Vec3d rest = in_line(of_a, b) + in_line(of_b, a) - at_[a] - at_[b];
    for (uint32_t f : faces) {
      const uint32_t c = s_.apex(f, s_.edges[e]);
      const Vec3d over_ac = s_.wing(f, a, c) + at_[b] - at_[a] - at_[c];
      const Vec3d over_bc = s_.wing(f, b, c) + at_[a] - at_[b] - at_[c];
      q -= 1.0 / 16 * (factor_[s_.edge(a, c)] * over_ac + factor_[s_.edge(b, c)] * over_bc);
      rest += 2.0 * at_[c] - s_.wing(f, a, c) - s_.wing(f, b, c);
    }
    return q + options_.w * least_factor(e) * rest;
  }

  /// Applies the rule between a regular vertex a inside the surface and a regular vertex b on a curve.
  Vec3d interior_to_curve(uint32_t e, uint32_t a, uint32_t b, const Fan& of_b) const {
    uint32_t f = s_.edges[e].faces[0];  // to be the face at the curve
    uint32_t g = s_.edges[e].faces[1];
    if (!s_.is_curve(b, s_.apex(f, s_.edges[e]))) std::swap(f, g);
    const uint32_t p = s_.apex(f, s_.edges[e]);
    const uint32_t q = s_.apex(g, s_.edges[e]);
    const uint32_t b_next = of_b.ring[0] == p ? of_b.ring.back() : of_b.ring[0];
    return 5.0 / 8 * at_[a] + 3.0 / 8 * at_[b] + 1.0 / 16 * at_[p] + 3.0 / 16 * at_[q] - 1.0 / 16 * at_[b_next] -
           1.0 / 16 * s_.wing(f, a, p) - 1.0 / 8 * s_.wing(g, a, q);
  }

  /// Applies the rule between two regular vertices on curves.
  Vec3d curve_to_curve(uint32_t e) const {
    const auto& [a, b, faces, kind] = s_.edges[e];
    for (uint32_t f : faces) {
      const uint32_t outer = s_.apex(f, s_.edges[e]);
      if (!s_.is_curve(a, outer) || !s_.is_curve(b, outer)) continue;
      const uint32_t g = s_.across(f, e);
      const uint32_t inner = s_.apex(g, s_.edges[e]);
      return s_.middle(e) + 0.25 * at_[inner] - 1.0 / 8 * (s_.wing(g, a, inner) + s_.wing(g, b, inner));
    }
    return s_.middle(e);
  }

  /// Applies the rule of an irregular end.
  Vec3d irregular(uint32_t e, uint32_t centre, Fan fan) const {
    const auto spoke = std::ranges::find(fan.ring, s_.edges[e].other(centre));
    if (!fan.closed) return lessened(e, curve_rule(centre, fan, spoke - fan.ring.begin()));
    std::ranges::rotate(fan.ring, spoke);
    std::vector<double> factor;
    for (uint32_t v : fan.ring) factor.push_back(factor_[s_.edge(centre, v)]);
    constexpr size_t many = 33;  // from here on the least factor counts for all
    if (fan.faces() < many) return interior_rule(centre, fan.ring, factor);
    const Vec3d q = interior_rule(centre, fan.ring, std::vector<double>(factor.size(), 1));
    return s_.middle(e) + *std::ranges::min_element(factor) * (q - s_.middle(e));
  }

  /// Splits a spoke of an open fan by the extraordinary crease rule.
  Vec3d curve_rule(uint32_t centre, const Fan& fan, ptrdiff_t spoke) const {
    const auto k = static_cast<double>(fan.faces());
    const double t = std::numbers::pi / k;
    const double it = static_cast<double>(spoke) * t;
    const double end =
        0.25 * std::cos(it) - std::sin(2 * t) * std::sin(2 * it) / (4 * k * (std::cos(t) - std::cos(2 * t)));
    Vec3d q = (1 - std::sin(t) * std::sin(it) / (k * (1 - std::cos(t)))) * at_[centre] +
              end * (at_[fan.ring.front()] - at_[fan.ring.back()]);
    for (size_t j = 1; j < fan.faces(); ++j) {
      const double jt = static_cast<double>(j) * t;
      q += (std::sin(it) * std::sin(jt) + 0.5 * std::sin(2 * it) * std::sin(2 * jt)) / k * at_[fan.ring[j]];
    }
    return q;
  }

  /// Splits spoke 0 of a closed fan of K faces. The two faces at the spoke predict the ring. Each neighbour's
  /// difference from its prediction is weighted by the hinges on the way. With all factors 1 this is the plain K rule.
  Vec3d interior_rule(uint32_t centre, const std::vector<uint32_t>& ring, const std::vector<double>& factor) const {
    const size_t k = ring.size();
    const double angle = 2 * std::numbers::pi / static_cast<double>(k);
    const auto cosine = [&](size_t j) { return std::cos(static_cast<double>(j) * angle); };
    const auto sine_ratio = [&](size_t j) { return std::sin(static_cast<double>(j) * angle) / std::sin(angle); };
    const auto weight = [&](size_t j) {
      if (k == 3) return j == 0 ? 5.0 / 12 : -1.0 / 12;
      if (k == 4) return j == 0 ? 3.0 / 8 : j == 2 ? -1.0 / 8 : 0;
      return (0.25 + cosine(j) + 0.5 * cosine(2 * j)) / static_cast<double>(k);
    };
    const auto u = [&](size_t j) { return at_[ring[j]] - at_[centre]; };
    double fold = 0;
    for (size_t j = 1; 2 * j < k; ++j) fold += weight(j) * sine_ratio(j);
    Vec3d q = at_[centre] + 0.5 * u(0) + factor[0] * fold * (u(1) + u(k - 1) - 2 * cosine(1) * u(0));
    for (size_t j = 2; j + 2 <= k; ++j) {
      const size_t steps = std::min(j, k - j);
      double ahead = 1;
      double back = 1;
      for (size_t i = 1; i < steps; ++i) ahead *= factor[i], back *= factor[k - i];
      const double on_the_way = 2 * j < k ? ahead : 2 * j > k ? back : std::max(ahead, back);
      const Vec3d predicted = sine_ratio(steps) * u(2 * j <= k ? 1 : k - 1) - sine_ratio(steps - 1) * u(0);
      q += on_the_way * weight(j) * (u(j) - predicted);
    }
    return q;
  }

  /// Applies the four-point rule: the midpoint less two second differences. A missing point lies in line.
  Vec3d along_curve(uint32_t e) const {
    Vec3d q = s_.middle(e);
    for (const uint32_t end : {s_.edges[e].a, s_.edges[e].b}) {
      const auto next = s_.beyond(e, end);
      if (!next) continue;
      const Vec3d other = at_[s_.edges[e].other(end)];
      const double turn = options_.tension == Tension::off ? 1 : cosine_of_turn(other, at_[end], at_[*next]);
      q -= 1.0 / 16 * hinge_factor(turn) * (at_[*next] + other - 2.0 * at_[end]);
    }
    return q;
  }

  bool is_sharp(uint32_t e) { return factor_[e] < 1 && margin_.is_less(factor_[e], 0.5, 3 * s_.slope); }

  /// Applies the four-point rule along the chain of sharp edges, where it turns by less than 60 degrees.
  Vec3d along_feature(uint32_t e) {
    Vec3d q = s_.middle(e);
    for (const uint32_t end : {s_.edges[e].a, s_.edges[e].b}) {
      std::vector<Vec3d> next;
      for (uint32_t hinge : s_.edges_at[end])
        if (hinge != e && is_sharp(hinge)) next.push_back(at_[s_.edges[hinge].other(end)]);
      if (!is_sharp(e) || next.size() != 1) continue;
      const Vec3d other = at_[s_.edges[e].other(end)];
      if (!margin_.is_less(cosine_of_turn(other, at_[end], next[0]), 0.5, s_.slope))
        q -= 1.0 / 16 * (next[0] + other - 2.0 * at_[end]);
    }
    return q;
  }

  /// Returns the least factor of an edge and the other sides of its faces.
  [[nodiscard]] double least_factor(uint32_t e) const {
    double least = 1;
    for (uint32_t f : s_.edges[e].faces)
      for (uint32_t side : s_.sides[f]) least = std::min(least, factor_[side]);
    return least;
  }
  /// Moves a point towards the edge's midpoint by the least factor.
  [[nodiscard]] Vec3d lessened(uint32_t e, Vec3d q) const {
    return s_.middle(e) + least_factor(e) * (q - s_.middle(e));
  }

  const Surface& s_;
  const std::vector<Vec3d>& at_;
  const Options& options_;
  Margin& margin_;
  std::vector<double> factor_{};  ///< [edge] as a hinge
};

}  // namespace papilio::reference
