#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "papilio/refine.h"

// Connectivity and geometry of the reference implementation (reference.h).

namespace papilio::reference {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Smallest margin of all decisions (reference.h).
struct Margin {
  double size;  ///< largest coordinate
  double least = infinity;
  bool is_disputed = false;  ///< reference.h
  /// Returns whether the quantity is below the limit. `slope`: its largest change per change of coordinates.
  bool is_less(double quantity, double limit, double slope) {
    const double margin = std::abs(quantity - limit) / (slope * size);
    least = margin >= 0 ? std::min(least, margin) : 0;  // NaN decides nothing
    return quantity < limit;
  }
};

enum class Kind { smooth, crease, boundary, shared };

struct Edge {
  uint32_t a, b;  ///< vertices, the lower number first
  std::vector<uint32_t> faces{};
  Kind kind = Kind::smooth;
  [[nodiscard]] uint32_t other(uint32_t vertex) const { return vertex == a ? b : a; }
};

/// Neighbours of a vertex counter-clockwise: from curve to curve, or all the way round.
struct Fan {
  std::vector<uint32_t> ring;
  bool closed;
  size_t curves = 0;     ///< edges to the ring that are not smooth
  bool is_dart = false;  ///< a crease ends at the vertex
  [[nodiscard]] size_t faces() const { return ring.size() - (closed ? 0 : 1); }
  [[nodiscard]] bool is_regular() const { return faces() == (closed ? 6 : 3); }
};

/// Returns the cosine of the turn from a by b to c.
inline double cosine_of_turn(Vec3d a, Vec3d b, Vec3d c) { return dot(b - a, c - b) / (length(b - a) * length(c - b)); }

struct Surface {
  using Pair = std::pair<uint32_t, uint32_t>;  ///< vertices of an edge, the lower number first

  Surface(std::vector<Vec3d> positions, std::vector<Triangle> triangles, std::set<Pair> creased)
      : at(std::move(positions)), faces(std::move(triangles)), creases(std::move(creased)), edges_at(at.size()) {
    for (uint32_t f = 0; f < faces.size(); ++f) {
      Triangle& side = sides.emplace_back();
      for (uint32_t i = 0; i < 3; ++i) {
        const Pair ends = std::minmax(faces[f][i], faces[f][(i + 1) % 3]);
        const auto [known, is_new] = number.try_emplace(ends, static_cast<uint32_t>(edges.size()));
        side[i] = known->second;
        if (is_new) edges.push_back({ends.first, ends.second});
        if (is_new) edges_at[ends.first].push_back(side[i]), edges_at[ends.second].push_back(side[i]);
        edges[side[i]].faces.push_back(f);
      }
      const double longest = std::max({length(side[0]), length(side[1]), length(side[2])});
      slope = std::max(slope, longest / papilio::length(area_normal(f)));
    }
    const auto runs_up = [&](const Edge& e, uint32_t f) { return next(f, e.a) == e.b; };
    for (Edge& e : edges)
      if (e.faces.size() != 2 || runs_up(e, e.faces[0]) == runs_up(e, e.faces[1]))
        e.kind = e.faces.size() == 1 ? Kind::boundary : Kind::shared;
      else if (creases.contains({e.a, e.b}))
        e.kind = Kind::crease;
  }

  std::vector<Vec3d> at;
  std::vector<Triangle> faces;
  std::set<Pair> creases;
  std::vector<Edge> edges{};
  std::vector<Triangle> sides{};  ///< [face] edges; side i runs from corner i to the next
  std::map<Pair, uint32_t> number{};
  std::vector<std::vector<uint32_t>> edges_at;  ///< [vertex]
  double slope = 0;                             ///< of normals and angles: one by the smallest height of a face

  [[nodiscard]] uint32_t edge(uint32_t v, uint32_t w) const { return number.at(std::minmax(v, w)); }
  [[nodiscard]] bool is_curve(uint32_t v, uint32_t w) const { return edges[edge(v, w)].kind != Kind::smooth; }
  /// Returns whether an edge has a face on each side.
  [[nodiscard]] bool joins(uint32_t e) const { return edges[e].kind == Kind::smooth || edges[e].kind == Kind::crease; }
  [[nodiscard]] Vec3d middle(uint32_t e) const { return 0.5 * (at[edges[e].a] + at[edges[e].b]); }
  [[nodiscard]] double length(uint32_t e) const { return papilio::length(at[edges[e].a] - at[edges[e].b]); }
  [[nodiscard]] Vec3d area_normal(uint32_t f) const {
    return cross(at[faces[f][1]] - at[faces[f][0]], at[faces[f][2]] - at[faces[f][0]]);
  }
  [[nodiscard]] Vec3d normal(uint32_t f) const { return (1 / papilio::length(area_normal(f))) * area_normal(f); }
  /// Returns the cosine between the normals at an edge that joins two faces.
  [[nodiscard]] double cosine(uint32_t e) const { return dot(normal(edges[e].faces[0]), normal(edges[e].faces[1])); }
  /// Returns the corner of a face so many steps after corner v.
  [[nodiscard]] uint32_t next(uint32_t f, uint32_t v, int steps = 1) const {
    return faces[f][(std::ranges::find(faces[f], v) - faces[f].begin() + steps) % 3];
  }
  /// Returns the side of a face so many steps after the side that leaves corner v.
  [[nodiscard]] uint32_t side(uint32_t f, uint32_t v, int steps = 0) const {
    return sides[f][(std::ranges::find(faces[f], v) - faces[f].begin() + steps) % 3];
  }
  [[nodiscard]] uint32_t apex(uint32_t f, const Edge& e) const { return next(f, e.a, next(f, e.a) == e.b ? 2 : 1); }
  [[nodiscard]] uint32_t across(uint32_t f, uint32_t e) const { return edges[e].faces[edges[e].faces[0] == f ? 1 : 0]; }
  /// Returns the position of the vertex across the edge v w of a face.
  [[nodiscard]] Vec3d wing(uint32_t f, uint32_t v, uint32_t w) const {
    return at[apex(across(f, edge(v, w)), edges[edge(v, w)])];
  }

  /// Returns the fan of a vertex that a face is in. Curves end it, but a crease that is alone in it does not (a dart).
  [[nodiscard]] Fan fan(uint32_t v, uint32_t f) const {
    Fan all = walk(v, f, true);
    all.is_dart = all.closed && all.curves == 1;
    return all.is_dart || all.curves == 0 ? all : walk(v, f, false);
  }
  /// Collects a fan from its clockwise end.
  [[nodiscard]] Fan walk(uint32_t v, uint32_t f, bool crosses_creases) const {
    const auto ends = [&](uint32_t e) { return edges[e].kind != Kind::smooth && !(crosses_creases && joins(e)); };
    uint32_t g = f;  // the first face clockwise
    while (!ends(side(g, v)) && across(g, side(g, v)) != f) g = across(g, side(g, v));
    Fan fan{.ring = {}, .closed = !ends(side(g, v))};
    const auto add = [&](uint32_t e) {
      fan.ring.push_back(edges[e].other(v));
      fan.curves += edges[e].kind == Kind::smooth ? 0 : 1;
    };
    add(side(g, v));
    uint32_t e = side(g, v, 2);
    for (; !ends(e) && edges[e].other(v) != fan.ring[0]; e = side(g, v, 2)) {
      add(e);
      g = across(g, e);
    }
    if (!fan.closed) add(e);
    return fan;
  }

  /// Returns the next vertex after v on the curve that an edge is on. Where more than two edges on curves meet, a
  /// boundary follows the rim of its faces, and others end.
  [[nodiscard]] std::optional<uint32_t> beyond(uint32_t e, uint32_t v) const {
    std::vector<uint32_t> others;
    for (uint32_t other : edges_at[v])
      if (other != e && edges[other].kind != Kind::smooth) others.push_back(edges[other].other(v));
    if (others.size() == 1) return others[0];
    if (edges[e].kind != Kind::boundary) return std::nullopt;
    const Fan rim = walk(v, edges[e].faces[0], true);
    return rim.ring[0] == edges[e].other(v) ? rim.ring.back() : rim.ring[0];
  }

  /// Returns the distance from an edge's new vertex to the nearer of its faces; on a curve, to the edge.
  [[nodiscard]] double deviation(uint32_t edge, Vec3d q) const {
    const Edge& e = edges[edge];
    double least = distance_to_segment(q, at[e.a], at[e.b]);
    for (size_t i = 0; e.kind == Kind::smooth && i < 2; ++i) {
      const Vec3d n = normal(e.faces[i]);
      bool is_above = true;
      for (uint32_t v : faces[e.faces[i]]) {
        const Vec3d from = at[v];
        const Vec3d to = at[next(e.faces[i], v)];
        is_above &= dot(cross(to - from, q - from), n) >= 0;
        least = std::min(least, distance_to_segment(q, from, to));
      }
      if (is_above) least = std::min(least, std::abs(dot(q - at[e.a], n)));
    }
    return least;
  }
  [[nodiscard]] static double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
    const double share = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
    return papilio::length(p - a - share * (b - a));
  }
};

/// Returns the pieces of a face if the sides in `mask` (bit i: side i) are split at the new vertices `middle`.
inline std::vector<Triangle> pieces(Triangle corner, Triangle middle, unsigned mask, bool second_diagonal = false) {
  if (mask == 0) return {corner};
  if (mask != 1 && mask != 3 && mask != 7) {  // rotate the split sides to the front
    std::ranges::rotate(corner, corner.begin() + 1);
    std::ranges::rotate(middle, middle.begin() + 1);
    return pieces(corner, middle, mask >> 1U | (mask & 1U) << 2U, second_diagonal);
  }
  const auto& [a, b, c] = corner;
  const auto& [ab, bc, ca] = middle;
  if (mask == 7) return {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}};
  if (mask == 1) return {{a, ab, c}, {ab, b, c}};
  if (second_diagonal) return {{ab, b, bc}, {a, ab, c}, {ab, bc, c}};
  return {{ab, b, bc}, {a, ab, bc}, {a, bc, c}};
}

}  // namespace papilio::reference
