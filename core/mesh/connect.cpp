#include "mesh/connect.h"

#include <algorithm>
#include <compare>
#include <span>

#include "base/ids.h"
#include "base/sort.h"

namespace papilio {
namespace {

/// Half-edge, to be sorted by its two vertices.
struct EdgeSide {
  uint32_t lower, higher, half_edge;
  friend auto operator<=>(const EdgeSide&,
                          const EdgeSide&) = default;  // NOLINT(modernize-use-nullptr): a bug of version 14
};
/// Half-edges between one pair of vertices, in ascending order.
using EdgeSides = std::span<const EdgeSide>;

/// Returns the chosen half-edges, edge by edge.
template <class IsChosen>
Buffer<EdgeSide> sort_into_edges(const Topology& mesh, const IsChosen& is_chosen) {
  Buffer<EdgeSide> sides;
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h)
    if (is_chosen(h))
      sides.push_back({std::min(mesh.origin[h], mesh.tip(h)), std::max(mesh.origin[h], mesh.tip(h)), h});
  sort_range(sides);
  return sides;
}
Buffer<EdgeSide> sort_into_edges(const Topology& mesh) {
  return sort_into_edges(mesh, [](uint32_t) { return true; });
}

/// Calls visit(sides) for each edge.
template <class Visit>
void for_each_edge(const Buffer<EdgeSide>& sides, const Visit& visit) {
  for (size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].lower == sides[first].lower && sides[last].higher == sides[first].higher)
      ++last;
    visit(EdgeSides(&sides[first], last - first));
  }
}

/// Drops each face that has the vertices and orientation of an earlier one. Only faces at edges with two half-edges in
/// one direction are candidates. Returns the number of dropped faces. `corner_point` [H] or empty.
uint32_t drop_repeated_faces(Topology& mesh, const Buffer<EdgeSide>& sides, std::vector<uint32_t>& corner_point) {
  struct Candidate {
    Triangle rotated;  ///< vertices, the lowest first
    FaceId face;
  };
  std::vector<Candidate> candidates;
  for_each_edge(sides, [&](EdgeSides edge) {
    const auto forward =
        std::ranges::count_if(edge, [&](const EdgeSide& side) { return mesh.origin[side.half_edge] == side.lower; });
    if (forward < 2 && static_cast<ptrdiff_t>(edge.size()) - forward < 2) return;
    for (const EdgeSide& side : edge) {
      HalfEdgeId h = Topology::face(side.half_edge) * 3;
      for (int turn = 0; turn < 2 && mesh.origin[h] > std::min(mesh.tip(h), mesh.apex(h)); ++turn) ++h;
      candidates.push_back({{mesh.origin[h], mesh.tip(h), mesh.apex(h)}, h.face()});
    }
  });
  sort_range(candidates, [](const Candidate& a, const Candidate& b) {
    return a.rotated != b.rotated ? a.rotated < b.rotated : a.face < b.face;
  });
  std::vector<bool> repeated;
  uint32_t dropped = 0;
  for (size_t c = 1; c < candidates.size(); ++c) {
    if (candidates[c].rotated != candidates[c - 1].rotated || candidates[c].face == candidates[c - 1].face) continue;
    if (repeated.empty()) repeated.resize(mesh.face_count());
    if (!repeated[candidates[c].face]) ++dropped;
    repeated[candidates[c].face] = true;
  }
  if (dropped == 0) return 0;
  uint32_t kept = 0;
  for (FaceId f = 0; f < repeated.size(); ++f) {
    if (repeated[f]) continue;
    std::copy_n(mesh.origin.begin() + 3 * f, 3, mesh.origin.begin() + 3 * kept);
    if (!corner_point.empty()) std::copy_n(corner_point.begin() + 3 * f, 3, corner_point.begin() + 3 * kept);
    ++kept;
  }
  mesh.origin.resize_for_overwrite(size_t{3} * kept);
  if (!corner_point.empty()) corner_point.resize(mesh.origin.size());
  return dropped;
}

/// Finds twins, and numbers edges as number_edges() does, in one pass, if every edge has one face or two with
/// consistent orientation. Known edges are listed at their lower vertex. Fails where an edge has other faces, or a list
/// exceeds `most_steps`.
class ManifoldConnector {
 public:
  explicit ManifoldConnector(Topology& mesh) : mesh_(mesh), first_at_(mesh.vertex_count, none) {}

  bool run(BuildReport& report) {
    const uint32_t count = mesh_.half_edge_count();
    mesh_.twin.resize_for_overwrite(count);
    mesh_.edge.resize_for_overwrite(count);
    mesh_.half_edge.resize_for_overwrite(count);
    known_.resize_for_overwrite(count);
    for (uint32_t first = 0; first < count; first += 3)
      for (HalfEdgeId h = first; h < first + 3; ++h)
        if (!add(h, mesh_.origin[h], mesh_.origin[h == first + 2 ? first : h + 1])) return false;
    mesh_.half_edge.resize_for_overwrite(edges_);
    mesh_.kind.assign(edges_, EdgeKind::smooth);
    if (2 * size_t{edges_} == count) return true;
    for (EdgeId e = 0; e < edges_; ++e) {
      if (mesh_.twin[mesh_.half_edge[e]] != none) continue;
      mesh_.kind[e] = EdgeKind::boundary;
      ++report.boundary_edges;
    }
    return true;
  }

 private:
  struct Known {
    uint32_t higher;  ///< higher vertex of the edge
    uint32_t next;    ///< next edge in the list of its lower vertex, or `none`
  };
  static constexpr int most_steps = 32;

  bool add(HalfEdgeId h, uint32_t from, uint32_t to) {
    uint32_t& first = first_at_[std::min(from, to)];
    const uint32_t higher = std::max(from, to);
    int steps = 0;
    for (EdgeId e = first; e != none; e = known_[e].next) {
      if (known_[e].higher == higher) return join(h, from, e);
      if (++steps > most_steps) return false;
    }
    known_[edges_] = {higher, first};
    first = edges_;
    mesh_.twin[h] = none;
    mesh_.edge[h] = edges_;
    mesh_.half_edge[edges_++] = h;
    return true;
  }

  bool join(HalfEdgeId h, uint32_t from, EdgeId e) {
    const uint32_t t = mesh_.half_edge[e];
    if (mesh_.twin[t] != none || mesh_.origin[t] == from) return false;
    mesh_.twin[h] = t;
    mesh_.twin[t] = h;
    mesh_.edge[h] = e;
    return true;
  }

  Topology& mesh_;
  Buffer<uint32_t> first_at_;  ///< [V] first edge of which this is the lower vertex, or `none`
  Buffer<Known> known_;        ///< [E]
  uint32_t edges_ = 0;
};

/// Returns the number of faces in the fan of half-edge h. Fans end where there is no twin.
uint32_t fan_size(const Topology& mesh, HalfEdgeId h) {
  uint32_t size = 0;
  uint32_t s = h;
  do {
    ++size;
    s = mesh.twin[Topology::previous(s)];
  } while (s != none && s != h);
  if (s == none)
    for (s = mesh.twin[h]; s != none; s = mesh.twin[Topology::next(s)]) ++size;
  return size;
}

}  // namespace

void connect(Topology& mesh, std::vector<uint32_t>& corner_point, BuildReport& report) {
  if (ManifoldConnector(mesh).run(report)) return;
  forget_edges(mesh);
  Buffer<EdgeSide> sides = sort_into_edges(mesh);
  report.repeated_faces = drop_repeated_faces(mesh, sides, corner_point);
  if (report.repeated_faces > 0) sides = sort_into_edges(mesh);
  mesh.twin.assign(mesh.half_edge_count(), none);
  for_each_edge(sides, [&](EdgeSides edge) {
    const uint32_t first = edge.front().half_edge;
    const uint32_t last = edge.back().half_edge;
    if (edge.size() == 2 && mesh.origin[first] != mesh.origin[last]) {
      mesh.twin[first] = last;
      mesh.twin[last] = first;
    } else {
      ++(edge.size() == 1   ? report.boundary_edges
         : edge.size() == 2 ? report.misoriented_edges
                            : report.non_manifold_edges);
    }
  });
  number_edges(mesh);
}

std::vector<uint32_t> find_pinched(const Topology& mesh) {
  Buffer<uint32_t> corners(mesh.vertex_count, 0);
  auto last = Buffer<uint32_t>::for_overwrite(mesh.vertex_count);
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h) {
    ++corners[mesh.origin[h]];
    last[mesh.origin[h]] = h;
  }
  std::vector<uint32_t> pinched;  // vertices at which the fan of one corner does not contain all others
  for (VertexId v = 0; v < mesh.vertex_count; ++v)
    if (fan_size(mesh, last[v]) != corners[v]) pinched.push_back(v);
  return pinched;
}

// Numbers edges in the order of their first half-edges, so that they lie in memory in the order of faces.
void number_edges(Topology& mesh) {
  if (mesh.has_edges()) return;
  mesh.darts.clear();
  mesh.edge.assign(mesh.half_edge_count(), none);
  // Half-edges without a twin between one pair of vertices share an edge: all but the first get its number later.
  const Buffer<EdgeSide> open = sort_into_edges(mesh, [&](HalfEdgeId h) { return mesh.twin[h] == none; });
  for_each_edge(open, [&](EdgeSides edge) {
    for (const EdgeSide& side : edge.subspan(1)) mesh.edge[side.half_edge] = 0;
  });
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h) {
    if (mesh.edge[h] != none) continue;
    mesh.edge[h] = mesh.edge_count();
    if (mesh.twin[h] != none) mesh.edge[mesh.twin[h]] = mesh.edge[h];
    mesh.half_edge.push_back(h);
    mesh.kind.push_back(mesh.twin[h] == none ? EdgeKind::boundary : EdgeKind::smooth);
  }
  for_each_edge(open, [&](EdgeSides edge) {
    const uint32_t number = mesh.edge[edge.front().half_edge];
    for (const EdgeSide& side : edge.subspan(1)) mesh.edge[side.half_edge] = number;
    if (edge.size() > 1) mesh.kind[number] = EdgeKind::shared;
  });
}

void forget_edges(Topology& mesh) {
  mesh.edge = {};
  mesh.half_edge = {};
  mesh.kind = {};
}

Topology connect_faces(Buffer<uint32_t> origin, uint32_t vertex_count) {
  Topology mesh;
  mesh.origin = std::move(origin);
  mesh.vertex_count = vertex_count;
  BuildReport report;
  std::vector<uint32_t> no_points;
  connect(mesh, no_points, report);
  mesh.pinched = find_pinched(mesh);
  return mesh;
}

}  // namespace papilio
