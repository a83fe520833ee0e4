#include "detail/sharp_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/crease.h"
#include "mesh/curve.h"
#include "mesh/hinge.h"

namespace papilio {
namespace {

constexpr double degree = std::numbers::pi / 180;
/// Lower bound of the angle between the normals at a sharp edge.
constexpr double sharp_angle = 40 * degree;
/// Lower bound of the angle by which a curve turns at a corner.
constexpr double corner_angle = 50 * degree;
/// Lower bound of the length of clean curves, a share of the length of sharp edges. Below it, all sharp edges are
/// noise.
constexpr double least_clean_share = 0.5;
/// Share of hard edges in the length of sharp edges from which on only hard edges count.
constexpr double decisive_hard_share = 0.5;
constexpr int most_rounds_of_noise = 4;

/// Sharp edges of a surface, grouped in rows that become curves.
class SharpEdges {
 public:
  SharpEdges(Mesh& mesh, const std::vector<bool>& is_hard)
      : mesh_(mesh), topology_(mesh.topology), is_hard_(is_hard), is_sharp_(mesh.topology.edge_count()) {
    double sharp_length = 0, hard_length = 0;
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (topology_.kind[e] != EdgeKind::smooth) continue;
      const double cosine = Hinge(topology_, mesh.positions, topology_.half_edge[e]).cosine();
      is_sharp_[e] = cosine < std::cos(sharp_angle);
      if (is_hard.empty() || !is_sharp_[e]) continue;
      sharp_length += edge_length(e);
      hard_length += is_hard[e] ? edge_length(e) : 0;
    }
    if (is_hard.empty()) return;
    const bool is_decisive = hard_length >= decisive_hard_share * sharp_length;
    for (uint32_t e = 0; e < topology_.edge_count(); ++e)
      if (topology_.kind[e] == EdgeKind::smooth) is_sharp_[e] = is_hard[e] || (is_sharp_[e] && !is_decisive);
  }

  void mark() {
    const double before = length_of_all();
    for (int round = 0; round < most_rounds_of_noise && drop_noise(); ++round) {
    }
    if (length_of_all() < least_clean_share * before) return;
    for (uint32_t e = 0; e < topology_.edge_count(); ++e)
      if (is_sharp_[e]) topology_.kind[e] = EdgeKind::crease;
    topology_.darts = find_darts(topology_);
  }

 private:
  /// Sharp edges from one vertex at which they end, or branch, to the next.
  struct Row {
    std::vector<uint32_t> edges;
    double turn = 0;     ///< sum of the turns between edges
    int loose_ends = 0;  ///< number of ends without another curve
    bool is_closed = false;
    bool is_hard = true;  ///< whether all edges are hard
  };

  [[nodiscard]] double edge_length(uint32_t e) const {
    const uint32_t h = topology_.half_edge[e];
    return length(to_double(mesh_.positions[topology_.tip(h)]) - to_double(mesh_.positions[topology_.origin[h]]));
  }
  [[nodiscard]] double length_of_all() const {
    double sum = 0;
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) sum += is_sharp_[e] ? edge_length(e) : 0;
    return sum;
  }

  /// Makes rows that are not clean smooth. Returns whether there were any.
  bool drop_noise() {
    at_vertex_.assign(topology_.vertex_count, {});
    on_boundary_.assign(topology_.vertex_count, false);
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
      const uint32_t h = topology_.half_edge[e];
      for (const uint32_t v : {topology_.origin[h], topology_.tip(h)}) {
        if (is_sharp_[e]) at_vertex_[v].push_back(e);
        if (topology_.kind[e] == EdgeKind::boundary) on_boundary_[v] = true;
      }
    }
    is_taken_.assign(topology_.edge_count(), false);
    std::vector<uint32_t> dropped;
    for (const bool is_end : {true, false})
      for (uint32_t v = 0; v < topology_.vertex_count; ++v) {
        if (is_end == passes(v)) continue;
        for (const uint32_t e : at_vertex_[v]) {
          if (is_taken_[e]) continue;
          const Row row = follow(v, e);
          if (!is_clean(row)) dropped.insert(dropped.end(), row.edges.begin(), row.edges.end());
        }
      }
    for (const uint32_t e : dropped) is_sharp_[e] = false;
    return !dropped.empty();
  }

  [[nodiscard]] bool passes(uint32_t v) const { return at_vertex_[v].size() == 2 && !on_boundary_[v]; }
  [[nodiscard]] bool is_loose(uint32_t v) const { return at_vertex_[v].size() == 1 && !on_boundary_[v]; }
  [[nodiscard]] uint32_t other_end(uint32_t e, uint32_t v) const {
    const uint32_t h = topology_.half_edge[e];
    return topology_.origin[h] == v ? topology_.tip(h) : topology_.origin[h];
  }

  Row follow(uint32_t start, uint32_t e) {
    Row row;
    uint32_t v = start;
    row.loose_ends += is_loose(v) ? 1 : 0;
    for (;;) {
      is_taken_[e] = true;
      row.edges.push_back(e);
      row.is_hard = row.is_hard && !is_hard_.empty() && is_hard_[e];
      const uint32_t next = other_end(e, v);
      if (next == start && passes(next)) {
        row.is_closed = true;
        return row;
      }
      if (!passes(next)) {
        row.loose_ends += is_loose(next) ? 1 : 0;
        return row;
      }
      const uint32_t on = at_vertex_[next][0] == e ? at_vertex_[next][1] : at_vertex_[next][0];
      row.turn += turn_between(v, next, other_end(on, next));
      v = next;
      e = on;
    }
  }

  [[nodiscard]] double turn_between(uint32_t a, uint32_t b, uint32_t c) const {
    const Vec3d one = to_double(mesh_.positions[b]) - to_double(mesh_.positions[a]);
    const Vec3d two = to_double(mesh_.positions[c]) - to_double(mesh_.positions[b]);
    return std::atan2(length(cross(one, two)), dot(one, two));
  }

  /// Returns whether a row is no noise. Noise on a scan makes short rows with loose ends that turn at each edge. Hard
  /// rows without loose ends are intended.
  [[nodiscard]] static bool is_clean(const Row& row) {
    const auto edges = static_cast<double>(row.edges.size());
    const double turn = row.turn / std::max(1.0, edges - 1);
    if (row.is_hard && row.loose_ends == 0) return true;
    if (row.is_closed) return edges >= 4 && turn <= 65 * degree;
    if (row.loose_ends == 0) return edges < 3 || turn <= 40 * degree;
    if (row.loose_ends == 1) return edges >= 6 && turn <= 25 * degree;
    return edges >= 10 && turn <= 20 * degree;
  }

  Mesh& mesh_;
  Topology& topology_;
  const std::vector<bool>& is_hard_;              // [E] or empty
  std::vector<bool> is_sharp_;                    // [E]
  std::vector<bool> is_taken_;                    // [E] whether the edge is in a row
  std::vector<std::vector<uint32_t>> at_vertex_;  // [V] sharp edges
  std::vector<bool> on_boundary_;                 // [V]
};

VertexDegrees degrees_of(const Topology& t, const std::vector<uint32_t>& seams = {}) {
  return {t, [&](uint32_t e) { return t.kind[e] != EdgeKind::smooth || std::ranges::binary_search(seams, e); }};
}

/// Finds the corners of the mesh's curves.
void mark_corners(Mesh& mesh) {
  Topology& t = mesh.topology;
  const VertexDegrees curves = degrees_of(t);
  std::vector<uint32_t> one_end(t.vertex_count, none);
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    if (t.kind[e] == EdgeKind::smooth) continue;
    one_end[t.origin[t.half_edge[e]]] = t.tip(t.half_edge[e]);
    one_end[t.tip(t.half_edge[e])] = t.origin[t.half_edge[e]];
  }
  t.shape.corners.clear();
  for (uint32_t v = 0; v < t.vertex_count; ++v) {
    if (curves.degree[v] != 2) continue;
    const Vec3d place = to_double(mesh.positions[v]);
    const Vec3d in = place - to_double(mesh.positions[one_end[v]]);
    const Vec3d out = to_double(mesh.positions[curves.neighbours[v] ^ one_end[v]]) - place;
    if (std::atan2(length(cross(in, out)), dot(in, out)) > corner_angle) t.shape.corners.push_back(v);
  }
}

}  // namespace

void mark_sharp_curves(Mesh& mesh, const std::vector<bool>& is_hard) {
  SharpEdges(mesh, is_hard).mark();
  mark_corners(mesh);
}

std::vector<CurveRole> curve_roles(const Topology& topology, const std::vector<uint32_t>& seams) {
  const VertexDegrees curves = degrees_of(topology, seams);
  std::vector<CurveRole> roles;
  roles.reserve(topology.vertex_count);
  for (const uint8_t count : curves.degree)
    roles.push_back(count == 0 ? CurveRole::smooth : count == 2 ? CurveRole::inner : CurveRole::corner);
  for (const uint32_t v : topology.shape.corners) roles[v] = CurveRole::corner;
  return roles;
}

}  // namespace papilio
