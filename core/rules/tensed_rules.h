#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/trigonometry.h"
#include "mesh/fan.h"
#include "rules/stencil.h"
#include "rules/tension.h"
#include "simd/extremes.h"
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
  /// Returns the sines of the angles to the neighbours 0, 1, .. of K.
  [[nodiscard]] const double* sines(uint32_t valence) const { return sine_[valence].data(); }
  /// Returns the cosine of the angle from one neighbour to the next.
  [[nodiscard]] double cosine(uint32_t valence) const { return cosine_[valence]; }

 private:
  std::array<std::array<double, stencil::harmonic_valence>, stencil::harmonic_valence> sine_{};
  std::array<double, stencil::harmonic_valence> cosine_{};
};

/// Butterfly rules under tension (tension.h), for one level. Where every factor is 1, they equal the plain rules except
/// for rounding. Each result depends on its stencil alone, to the bit.
template <class Real>
class TensedRules {
  using Point = Vec3T<Real>;

 public:
  /// `places` [V] are the level's positions, which select the rules; the rules are applied to `points` [V].
  TensedRules(const Topology& mesh, const Point* places, const Point* points, const TensionField& field)
      : mesh_(mesh), place_(places), p_(points), field_(field) {}

  /// Returns the new vertex of an edge with both ends interior and regular: the eight-point rule, with each of its four
  /// outer hinges scaled by its own factor.
  [[nodiscard]] Point interior_interior(HalfEdgeId h, HalfEdgeId t) const {
    return face_share(h, t) + face_share(t, h);
  }

  /// Adds the contributions of face f to `interior_interior` of its edges (butterfly_rules.h). `p` are its corners,
  /// `wing` the vertices across its edges.
  template <class Shares>
  void add_face_shares(FaceId f, const std::array<Wide<Real>, 3>& p, const std::array<Wide<Real>, 3>& wing,
                       Shares& shares) const {
    const uint32_t* edge = &mesh_.edge[size_t{3} * f];
    const uint32_t* twin = &mesh_.twin[size_t{3} * f];
    std::array<Wide<Real>, 3> hinge;
    for (uint32_t i = 0; i < 3; ++i)
      hinge[i] = second_difference(field_.factor[edge[i]], p[i], p[(i + 1) % 3], p[(i + 2) % 3], wing[i]);
    for (uint32_t i = 0; i < 3; ++i)
      shares.add(f, twin[i], edge[i], share(p[i], p[(i + 1) % 3], hinge[(i + 1) % 3], hinge[(i + 2) % 3]));
  }

  /// Returns the new vertex of spoke i of a closed fan of K faces, K != 2, not all of whose hinge factors are 1. The
  /// spoke's two faces predict the ring, marching round the vertex as on a regular ring. Differences from the
  /// prediction are scaled by the factors of the hinges on the way.
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

    std::array<Real, stencil::harmonic_valence> on_the_way{};  // product of the factors on the way to neighbour j
    Real product = 1;
    for (uint32_t j = 2; 2 * j <= k; ++j) on_the_way[j] = product *= factor(j - 1);
    product = 1;
    for (uint32_t j = 2; 2 * j <= k; ++j) {
      product *= factor(k - j + 1);
      on_the_way[k - j] = larger(on_the_way[k - j], product);
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

  /// Scales the result q of any other rule for the edge of h towards the midpoint, by the least factor of the edge and
  /// the four others of its two faces.
  [[nodiscard]] Point scaled(HalfEdgeId h, Point q) const { return scaled(h, q, least_factor(h)); }

  /// Scales q towards the midpoint of h by `factor`, the least of a whole fan's spokes.
  [[nodiscard]] Point scaled(HalfEdgeId h, Point q, Real factor) const {
    const Point m = midpoint(h);
    return factor == 1 ? q : m + factor * (q - m);
  }
  [[nodiscard]] Real least_factor(const Fan& fan) const {
    float least = 1;
    for (uint32_t s : fan.spokes) least = lesser(least, field_.factor[mesh_.edge[s]]);
    return Real(least);
  }
  /// Returns whether the hinge's factor is 1.
  [[nodiscard]] bool is_whole(EdgeId edge) const { return field_.factor[edge] == 1; }
  [[nodiscard]] Real least_factor(HalfEdgeId h) const {
    const HalfEdgeId t = mesh_.twin[h];
    float least = field_.factor[mesh_.edge[h]];
    for (uint32_t side : {h.next(), h.previous(), t.next(), t.previous()})
      least = lesser(least, field_.factor[mesh_.edge[side]]);
    return Real(least);
  }

  /// Four points along a curve: the point before an edge, its two ends, the point after it.
  using AlongCurve = std::array<Point, 4>;
  /// Applies the four-point rule, its second differences scaled by the factors of the curve's turns at the places. In
  /// mechanical meshes a longer neighbour counts by its direction alone: a side of a plate does not bend a short edge
  /// that follows it.
  [[nodiscard]] Point along_curve(const AlongCurve& points, const AlongCurve& places) const {
    const auto [before, a, b, after] = mesh_.shape.is_mechanical ? with_equal_sides(points, places) : points;
    return Real(0.5) * (a + b) -
           Real(0.0625) * (turn_factor(places[0], places[1], places[2]) * (before + b - Real(2) * a) +
                           turn_factor(places[1], places[2], places[3]) * (after + a - Real(2) * b));
  }

  /// Returns whether the shape rules hold, and h is the diagonal of a flat quadrangle two of whose sides are curves.
  [[nodiscard, gnu::always_inline]] bool is_diagonal_of_strip(HalfEdgeId h) const {
    return field_.shape && field_.shape->is_flat[mesh_.edge[h]] != 0 && sides_of_strip(mesh_, h)[0] != none;
  }

  /// Moves q of an edge with a factor below 1 towards the four-point rule along its feature, with `follow_features`.
  [[nodiscard, gnu::always_inline]] Point followed(HalfEdgeId h, Point q) const {
    if (!field_.follow_features || mesh_.twin[h] == none) return q;
    const auto factor = Real(field_.factor[mesh_.edge[h]]);
    return factor < 1 ? factor * q + (1 - factor) * along_feature(h) : q;
  }

  /// Limits the offset from the midpoint, and keeps flat regions flat. Applied last to every edge; for places only.
  [[nodiscard, gnu::always_inline]] Point limited(HalfEdgeId h, Point q) const {
    if (!field_.shape) return bounded(h, q);
    if (field_.shape->is_flat[mesh_.edge[h]] != 0 && has_flat_stencil(mesh_, *field_.shape, h)) return midpoint(h);
    return is_surely_within_bounds(h, q) ? q : unfolded(h, bounded(h, q));
  }

 private:
  [[nodiscard]] Point bounded(HalfEdgeId h, Point q) const {
    const Point m = midpoint(h);
    const Vec3d off = to_double(q - m);
    const Vec3d along = to_double(p_[mesh_.tip(h)] - p_[mesh_.origin[h]]);
    if (dot(off, off) < sure * tension_bound * tension_bound * dot(along, along)) return q;
    const double moved = length(off);
    const double most = tension_bound * length(along);
    return moved > most ? m + Real(most / moved) * (q - m) : q;
  }

  /// Share of the squared bounds below which exact tests are skipped. Most vertices are below it, which
  /// saves square roots.
  static constexpr double sure = 0.99;
  [[nodiscard, gnu::always_inline]] bool is_surely_within_bounds(HalfEdgeId h, Point q) const {
    const Vec3d off = to_double(q - midpoint(h));
    const Vec3d along = to_double(p_[mesh_.tip(h)] - p_[mesh_.origin[h]]);
    const double size = dot(along, along);
    const double slid = dot(off, along);
    return dot(off, off) < sure * tension_bound * tension_bound * size &&
           dot(off, off) * size - slid * slid < sure * inward_bound * inward_bound * least_squared_clearance(h) * size;
  }

  /// Returns the square of the least product of height and room of the faces at h.
  [[nodiscard]] double least_squared_clearance(HalfEdgeId h) const {
    const auto of = [&](FaceId f) {
      const double room = field_.shape->room(f);
      return field_.shape->squared_height[f] * room * room;
    };
    const HalfEdgeId t = mesh_.twin[h];
    if (t != none) return lesser(of(h.face()), of(t.face()));
    return is_shared(h) ? field_.shape->squared_height_at_shared[mesh_.edge[h]] : of(h.face());
  }

  [[nodiscard]] bool is_shared(HalfEdgeId h) const { return mesh_.kind[mesh_.edge[h]] == EdgeKind::shared; }

  /// Limits q so that no face folds (keep_unfolded()). At shared edges, limits the move across the edge to
  /// `inward_bound` of the least height of their faces. Returns q at cuts, where not all faces are known.
  [[nodiscard]] Point unfolded(HalfEdgeId h, Point q) const {
    const EdgeKind kind = mesh_.kind[mesh_.edge[h]];
    if (kind == EdgeKind::cut) return q;
    const Vec3d a = to_double(p_[mesh_.origin[h]]);
    const Vec3d b = to_double(p_[mesh_.tip(h)]);
    const Point m = midpoint(h);
    const Vec3d off = to_double(q) - to_double(m);
    const Vec3d kept = kind == EdgeKind::shared
                           ? shorten_across(off, a, b, inward_bound * std::sqrt(least_squared_clearance(h)))
                           : unfolded(h, off, a, b);
    if (kept == off) return q;
    const Vec3d at = to_double(m) + kept;
    return {static_cast<Real>(at.x), static_cast<Real>(at.y), static_cast<Real>(at.z)};
  }

  /// Limits the offset of an edge with one or two faces, from a to b.
  [[nodiscard]] Vec3d unfolded(HalfEdgeId h, Vec3d off, Vec3d a, Vec3d b) const {
    const HalfEdgeId t = mesh_.twin[h];
    const bool is_curve = mesh_.is_curve(h) || is_diagonal_of_strip(h);
    const auto face_at = [&](HalfEdgeId side) {
      const FaceId f = side.face();
      FaceAtEdge face{to_double(p_[mesh_.apex(side)]), std::sqrt(field_.shape->squared_height[f])};
      if (!is_curve)
        face.height *= field_.shape->room(f);
      else if (mesh_.shape.is_mechanical)
        face.room = room_on_curves(field_.shape->sharpest[f]);
      return face;
    };
    const std::array<FaceAtEdge, 2> faces{face_at(h), face_at(t == none ? h : t)};
    return keep_unfolded(off, a, b, std::span(faces).first(t == none ? 1 : 2),
                         mesh_.shape.is_mechanical ? mechanical_across_bound : organic_across_bound);
  }

  [[nodiscard]] Point midpoint(HalfEdgeId h) const { return Real(0.5) * (p_[mesh_.origin[h]] + p_[mesh_.tip(h)]); }

  /// Returns the contribution of the face of h, whose twin is t, to their edge: half the midpoint, and the
  /// face's two hinges.
  [[nodiscard]] Point face_share(HalfEdgeId h, HalfEdgeId t) const {
    return share(p_[mesh_.origin[h]], p_[mesh_.origin[t]], over_hinge(h.next(), mesh_.origin[h]),
                 over_hinge(h.previous(), mesh_.origin[t]));
  }
  template <class Any>
  [[nodiscard]] static Any share(Any a, Any b, Any hinge_1, Any hinge_2) {
    return Real(0.25) * (a + b) - Real(0.0625) * (hinge_1 + hinge_2);
  }

  /// Returns the second difference over the hinge of half-edge s; `opposite` is the corner of its face that
  /// it does not touch.
  [[nodiscard]] Point over_hinge(uint32_t s, uint32_t opposite) const {
    return second_difference(field_.factor[mesh_.edge[s]], p_[mesh_.origin[s]], p_[mesh_.tip(s)], p_[opposite],
                             p_[mesh_.apex(mesh_.twin[s])]);
  }
  template <class Any>
  [[nodiscard]] static Any second_difference(float factor, Any a, Any b, Any opposite, Any wing) {
    return Real(factor) * ((wing + opposite) - (a + b));
  }

  /// Moves the outer points towards the edge's ends until their distances from them are at most the edge's length.
  [[nodiscard]] static AlongCurve with_equal_sides(const AlongCurve& points, const AlongCurve& places) {
    const double most = length(to_double(places[2] - places[1]));
    const auto nearer = [&](size_t outer, size_t end) {
      const double size = length(to_double(places[outer] - places[end]));
      return size > most ? points[end] + Real(most / size) * (points[outer] - points[end]) : points[outer];
    };
    return {nearer(0, 1), points[1], points[2], nearer(3, 2)};
  }

  [[nodiscard]] static Real turn_factor(Point before, Point at, Point after) {
    const Vec3d u = to_double(at - before);
    const Vec3d v = to_double(after - at);
    const double size = length(u) * length(v);
    return size > 0 ? Real(hinge_factor(dot(u, v) / size)) : Real(1);
  }

  /// Applies the four-point rule along the chain of sharp edges that contains the edge of h.
  [[nodiscard]] Point along_feature(HalfEdgeId h) const {
    const uint32_t a = mesh_.origin[h];
    const uint32_t b = mesh_.tip(h);
    const bool sharp = field_.is_sharp(mesh_.edge[h]);
    const Point before = sharp ? beyond(a, b) : reflected(a, b);
    const Point after = sharp ? beyond(b, a) : reflected(b, a);
    return Real(9.0 / 16) * (p_[a] + p_[b]) - Real(0.0625) * (before + after);
  }

  /// Returns the feature's next vertex after `end`, coming from `other`, if it continues with a turn below 60 degrees.
  /// Otherwise returns the reflected point.
  [[nodiscard]] Point beyond(uint32_t end, uint32_t other) const {
    if (field_.features.degree[end] != 2) return reflected(end, other);
    const uint32_t next = field_.features.neighbours[end] ^ other;
    const Vec3d u = to_double(place_[end] - place_[other]);
    const Vec3d v = to_double(place_[next] - place_[end]);
    return dot(u, v) > 0.5 * length(u) * length(v) ? p_[next] : reflected(end, other);
  }
  [[nodiscard]] Point reflected(uint32_t end, uint32_t other) const { return Real(2) * p_[end] - p_[other]; }

  const Topology& mesh_;
  const Point *place_, *p_;
  const TensionField& field_;
};

}  // namespace papilio
