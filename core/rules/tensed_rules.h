#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/trigonometry.h"
#include "mesh/fan.h"
#include "rules/stencil.h"
#include "rules/tension.h"
#include "simd/vec3fa.h"

namespace papilio {

/// Sines and cosines round a ring, computed once.
class RingAngles {
 public:
  RingAngles() {
    for (uint32_t k = 3; k < stencil::harmonic_valence; ++k) {
      for (uint32_t j = 0; j < k; ++j) sine_[k][j] = sine_of_turn(j, k);
      cosine_[k] = cosine_of_turn(1, k);
    }
  }
  /// The sines of the angles to the neighbours 0, 1, .. of K.
  [[nodiscard]] const double* sines(uint32_t valence) const { return sine_[valence].data(); }
  /// The cosine of the angle from one neighbour to the next.
  [[nodiscard]] double cosine(uint32_t valence) const { return cosine_[valence]; }

 private:
  std::array<std::array<double, stencil::harmonic_valence>, stencil::harmonic_valence> sine_{};
  std::array<double, stencil::harmonic_valence> cosine_{};
};

/// The butterfly's rules under tension (tension.h), for one level. Where every factor is 1 they are the plain rules but
/// for rounding. Like those, each result depends on its stencil alone, to the bit.
template <class Real>
class TensedRules {
  using Point = Vec3T<Real>;

 public:
  /// `places` [V] are the level's positions, by which rules are chosen; `points` are what they are applied to.
  TensedRules(const Topology& mesh, const Point* places, const Point* points, const TensionField& field)
      : mesh_(mesh), place_(places), p_(points), field_(field) {}

  /// Both ends interior and regular: the eight-point rule, each of its four outer hinges by its own factor.
  [[nodiscard]] Point interior_interior(uint32_t h, uint32_t t) const { return face_share(h, t) + face_share(t, h); }

  /// The same face by face (butterfly_rules.h): `p` are face f's corners, `wing` the vertices across its edges.
  template <class Shares>
  void add_face_shares(uint32_t f, const std::array<Wide<Real>, 3>& p, const std::array<Wide<Real>, 3>& wing,
                       Shares& shares) const {
    const uint32_t* edge = &mesh_.edge[size_t{3} * f];
    const uint32_t* twin = &mesh_.twin[size_t{3} * f];
    std::array<Wide<Real>, 3> hinge;
    for (uint32_t i = 0; i < 3; ++i)
      hinge[i] = second_difference(field_.factor[edge[i]], p[i], p[(i + 1) % 3], p[(i + 2) % 3], wing[i]);
    for (uint32_t i = 0; i < 3; ++i)
      shares.add(f, twin[i], edge[i], share(p[i], p[(i + 1) % 3], hinge[(i + 1) % 3], hinge[(i + 2) % 3]));
  }

  /// Spoke i of a closed fan of K faces, K != 2, not all of whose hinges count whole. The ring is split into what the
  /// spoke's two faces foresee, marching round the vertex as on a regular ring, and the differences from that, each by
  /// the factors of the hinges that lie on the way.
  [[nodiscard]] Point interior_spoke(const Fan& fan, const Real* weights, uint32_t i) const {
    const uint32_t k = fan.valence();
    static const RingAngles angles;
    const double* sine = angles.sines(k);
    const Point a = p_[fan.centre];
    const auto index = [&](uint32_t j) { return i + j < k ? i + j : i + j - k; };
    const auto u = [&](uint32_t j) { return p_[fan.ring[index(j)]] - a; };
    const auto factor = [&](uint32_t j) { return Real(field_.factor[mesh_.edge[fan.spokes[index(j)]]]); };

    double fold = 0;
    for (uint32_t j = 1; 2 * j < k; ++j) fold += double(weights[j]) * sine[j] / sine[1];
    const Point u0 = u(0);
    const Point one = u(1);
    const Point last = u(k - 1);
    Point q = a + Real(0.5) * u0 + (factor(0) * Real(fold)) * (one + last - Real(2 * angles.cosine(k)) * u0);

    std::array<Real, stencil::harmonic_valence> on_the_way{};  // product of the factors crossed to reach neighbour j
    Real product = 1;
    for (uint32_t j = 2; 2 * j <= k; ++j) on_the_way[j] = product *= factor(j - 1);
    product = 1;
    for (uint32_t j = 2; 2 * j <= k; ++j) {
      product *= factor(k - j + 1);
      on_the_way[k - j] = std::max(on_the_way[k - j], product);
    }
    for (uint32_t j = 2; j + 2 <= k; ++j) {
      const uint32_t steps = std::min(j, k - j);
      const auto ahead = Real(sine[steps] / sine[1]);
      const auto behind = Real(sine[steps - 1] / sine[1]);
      const Point foreseen = ahead * (2 * j <= k ? one : last) - behind * u0;
      q += (on_the_way[j] * weights[j]) * (u(j) - foreseen);
    }
    return q;
  }

  /// Any other rule's result q for the edge of h: scaled towards the midpoint by the least factor of the edge and the
  /// four others of its two faces.
  [[nodiscard]] Point scaled(uint32_t h, Point q) const { return between(h, q, least_factor(h)); }

  /// The same by the least factor of a whole fan's spokes.
  [[nodiscard]] Point scaled(uint32_t h, Point q, Real factor) const { return between(h, q, factor); }
  [[nodiscard]] Real least_factor(const Fan& fan) const {
    float least = 1;
    for (uint32_t s : fan.spokes) least = std::min(least, field_.factor[mesh_.edge[s]]);
    return Real(least);
  }
  /// Whether the hinge counts whole.
  [[nodiscard]] bool is_whole(uint32_t edge) const { return field_.factor[edge] == 1; }
  [[nodiscard]] Real least_factor(uint32_t h) const {
    const uint32_t t = mesh_.twin[h];
    float least = field_.factor[mesh_.edge[h]];
    for (uint32_t side : {Topology::next(h), Topology::previous(h), Topology::next(t), Topology::previous(t)})
      least = std::min(least, field_.factor[mesh_.edge[side]]);
    return Real(least);
  }

  /// Four points along a curve: before an edge's first end, its two ends, after the second.
  using AlongCurve = std::array<Point, 4>;
  /// The four-point rule, its second differences by the factors of the curve's turns, which the places tell.
  [[nodiscard]] static Point along_curve(const AlongCurve& points, const AlongCurve& places) {
    const auto& [before, a, b, after] = points;
    return Real(0.5) * (a + b) -
           Real(0.0625) * (turn_factor(places[0], places[1], places[2]) * (before + b - Real(2) * a) +
                           turn_factor(places[1], places[2], places[3]) * (after + a - Real(2) * b));
  }

  /// Whether the shape rules hold, and h is the diagonal of a flat quadrangle two of whose sides are curves.
  [[nodiscard, gnu::always_inline]] bool is_diagonal_of_strip(uint32_t h) const {
    return field_.shape && field_.shape->is_flat[mesh_.edge[h]] != 0 && sides_of_strip(mesh_, h)[0] != none;
  }

  /// Sharp edges follow their feature.
  [[nodiscard, gnu::always_inline]] Point followed(uint32_t h, Point q) const {
    if (!field_.follow_features || mesh_.twin[h] == none) return q;
    const auto factor = Real(field_.factor[mesh_.edge[h]]);
    return factor < 1 ? factor * q + (1 - factor) * along_feature(h) : q;
  }

  /// What comes last for every edge: nothing goes far, and flat stays flat. Of places alone.
  [[nodiscard, gnu::always_inline]] Point limited(uint32_t h, Point q) const {
    if (!field_.shape) return bounded(h, q);
    if (field_.shape->is_flat[mesh_.edge[h]] != 0 && has_flat_stencil(mesh_, *field_.shape, h)) return midpoint(h);
    return is_surely_within_bounds(h, q) ? q : unfolded(h, bounded(h, q));
  }

 private:
  [[nodiscard]] Point bounded(uint32_t h, Point q) const {
    const Point m = midpoint(h);
    const Vec3d off = widen(q - m);
    const Vec3d along = widen(p_[mesh_.tip(h)] - p_[mesh_.origin[h]]);
    if (dot(off, off) < sure * tension_bound * tension_bound * dot(along, along)) return q;
    const double moved = length(off);
    const double most = tension_bound * length(along);
    return moved > most ? m + Real(most / moved) * (q - m) : q;
  }

  /// Most are, and spare the roots.
  static constexpr double sure = 0.99;
  [[nodiscard, gnu::always_inline]] bool is_surely_within_bounds(uint32_t h, Point q) const {
    const Vec3d off = widen(q - midpoint(h));
    const Vec3d along = widen(p_[mesh_.tip(h)] - p_[mesh_.origin[h]]);
    const double size = dot(along, along);
    const double slid = dot(off, along);
    return dot(off, off) < sure * tension_bound * tension_bound * size &&
           dot(off, off) * size - slid * slid < sure * inward_bound * inward_bound * least_squared_height(h) * size;
  }

  /// Of the faces at h.
  [[nodiscard]] double least_squared_height(uint32_t h) const {
    const uint32_t t = mesh_.twin[h];
    const Buffer<double>& height = field_.shape->squared_height;
    return t == none ? height[Topology::face(h)] : std::min(height[Topology::face(h)], height[Topology::face(t)]);
  }

  /// At shared edges the faces are not all known here: they stay as they are.
  [[nodiscard]] Point unfolded(uint32_t h, Point q) const {
    const EdgeKind kind = mesh_.kind[mesh_.edge[h]];
    if (kind == EdgeKind::shared || kind == EdgeKind::cut) return q;
    const uint32_t t = mesh_.twin[h];
    const auto face_at = [&](uint32_t side) {
      return FaceAtEdge{widen(p_[mesh_.apex(side)]), std::sqrt(field_.shape->squared_height[Topology::face(side)])};
    };
    const std::array<FaceAtEdge, 2> faces{face_at(h), face_at(t == none ? h : t)};
    const Point m = midpoint(h);
    const Vec3d off = widen(q) - widen(m);
    const Vec3d kept = keep_unfolded(off, widen(p_[mesh_.origin[h]]), widen(p_[mesh_.tip(h)]),
                                     std::span(faces).first(t == none ? 1 : 2),
                                     mesh_.shape.is_mechanical ? mechanical_across_bound : organic_across_bound);
    if (kept == off) return q;
    const Vec3d at = widen(m) + kept;
    return {static_cast<Real>(at.x), static_cast<Real>(at.y), static_cast<Real>(at.z)};
  }

  /// Squares of small floats would be nothing.
  [[nodiscard]] static Vec3d widen(Point p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  }
  [[nodiscard]] Point midpoint(uint32_t h) const { return Real(0.5) * (p_[mesh_.origin[h]] + p_[mesh_.tip(h)]); }

  [[nodiscard]] Point between(uint32_t h, Point q, Real factor) const {
    const Point m = midpoint(h);
    return factor == 1 ? q : m + factor * (q - m);
  }

  /// What the face of h, whose twin is t, knows of their edge: half the midpoint, and its own two hinges.
  [[nodiscard]] Point face_share(uint32_t h, uint32_t t) const {
    return share(p_[mesh_.origin[h]], p_[mesh_.origin[t]], over_hinge(Topology::next(h), mesh_.origin[h]),
                 over_hinge(Topology::previous(h), mesh_.origin[t]));
  }
  template <class Any>
  [[nodiscard]] static Any share(Any a, Any b, Any hinge_1, Any hinge_2) {
    return Real(0.25) * (a + b) - Real(0.0625) * (hinge_1 + hinge_2);
  }

  /// Second difference over the hinge of half-edge s; `opposite` is the corner of its face that it does not touch.
  [[nodiscard]] Point over_hinge(uint32_t s, uint32_t opposite) const {
    return second_difference(field_.factor[mesh_.edge[s]], p_[mesh_.origin[s]], p_[mesh_.tip(s)], p_[opposite],
                             p_[mesh_.apex(mesh_.twin[s])]);
  }
  template <class Any>
  [[nodiscard]] static Any second_difference(float factor, Any a, Any b, Any opposite, Any wing) {
    return Real(factor) * ((wing + opposite) - (a + b));
  }

  [[nodiscard]] static Real turn_factor(Point before, Point at, Point after) {
    const Vec3d u = widen(at - before);
    const Vec3d v = widen(after - at);
    const double size = length(u) * length(v);
    return size > 0 ? Real(hinge_factor(dot(u, v) / size)) : Real(1);
  }

  /// The four-point rule along the chain of sharp edges that the edge of h is in.
  [[nodiscard]] Point along_feature(uint32_t h) const {
    const uint32_t a = mesh_.origin[h];
    const uint32_t b = mesh_.tip(h);
    const bool sharp = field_.is_sharp(mesh_.edge[h]);
    const Point before = sharp ? beyond(a, b) : reflected(a, b);
    const Point after = sharp ? beyond(b, a) : reflected(b, a);
    return Real(9.0 / 16) * (p_[a] + p_[b]) - Real(0.0625) * (before + after);
  }

  /// The feature's next vertex after `end`, coming from `other`: where it goes on, turning by less than 60 degrees.
  [[nodiscard]] Point beyond(uint32_t end, uint32_t other) const {
    if (field_.features.degree[end] != 2) return reflected(end, other);
    const uint32_t next = field_.features.neighbours[end] ^ other;
    const Vec3d u = widen(place_[end] - place_[other]);
    const Vec3d v = widen(place_[next] - place_[end]);
    return dot(u, v) > 0.5 * length(u) * length(v) ? p_[next] : reflected(end, other);
  }
  [[nodiscard]] Point reflected(uint32_t end, uint32_t other) const { return Real(2) * p_[end] - p_[other]; }

  const Topology& mesh_;
  const Point *place_, *p_;
  const TensionField& field_;
};

}  // namespace papilio
