#include "mesh/connect.h"

#include <algorithm>
#include <array>

namespace papilio {
namespace {

/// Half-edges sorted into edges: a run of half-edges between the same two vertices each.
struct EdgeRuns {
  Buffer<uint32_t> half_edges;  ///< [H] ordered by lower vertex, then higher vertex, then half-edge
  Buffer<uint32_t> starts;      ///< where each run starts; one more at the end
};

/// A half-edge and the higher of its vertices, to be sorted by both.
struct EdgeEnd {
  uint32_t higher, half_edge;
  friend bool operator<(EdgeEnd a, EdgeEnd b) {
    return a.higher != b.higher ? a.higher < b.higher : a.half_edge < b.half_edge;
  }
};

/// Few as a rule, and nearly in order.
void sort_ends(EdgeEnd* first, EdgeEnd* last) {
  constexpr ptrdiff_t few = 24;
  if (last - first > few) {
    std::sort(first, last);
    return;
  }
  for (EdgeEnd* at = first; at != last; ++at) {
    const EdgeEnd end = *at;
    EdgeEnd* to = at;
    for (; to != first && end < to[-1]; --to) *to = to[-1];
    *to = end;
  }
}

EdgeRuns sort_into_edges(const Topology& mesh) {
  const uint32_t count = mesh.half_edge_count();
  Buffer<uint32_t> bucket(size_t{mesh.vertex_count} + 1, 0);  // of each lower vertex: where it ends, once it is filled
  const auto for_each_half_edge = [&](const auto& visit) {
    for (uint32_t first = 0; first < count; first += 3) {
      const uint32_t* v = &mesh.origin[first];
      visit(first, v[0], v[1]);
      visit(first + 1, v[1], v[2]);
      visit(first + 2, v[2], v[0]);
    }
  };
  for_each_half_edge([&](uint32_t, uint32_t a, uint32_t b) { ++bucket[std::min(a, b) + 1]; });
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) bucket[v + 1] += bucket[v];
  auto ends = Buffer<EdgeEnd>::for_overwrite(count);
  for_each_half_edge([&](uint32_t h, uint32_t a, uint32_t b) { ends[bucket[std::min(a, b)]++] = {std::max(a, b), h}; });

  EdgeRuns runs;
  runs.half_edges.resize_for_overwrite(count);
  runs.starts.resize_for_overwrite(size_t{count} + 1);
  uint32_t* start = runs.starts.data();
  uint32_t begin = 0;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const uint32_t end = bucket[v];
    sort_ends(&ends[begin], ends.data() + end);
    uint32_t higher = none;
    for (uint32_t k = begin; k < end; ++k) {
      runs.half_edges[k] = ends[k].half_edge;
      *start = k;
      start += ends[k].higher != higher ? 1 : 0;
      higher = ends[k].higher;
    }
    begin = end;
  }
  *start++ = count;
  runs.starts.resize_for_overwrite(static_cast<size_t>(start - runs.starts.data()));
  return runs;
}

/// Drops each face that has the vertices and orientation of an earlier one. Only faces at edges that two
/// half-edges run along in one direction can repeat. Returns how many were dropped. `corner_point` [H] or empty.
uint32_t drop_repeated_faces(Topology& mesh, const EdgeRuns& runs, std::vector<uint32_t>& corner_point) {
  struct Candidate {
    Triangle rotated;  ///< starting at its lowest vertex
    uint32_t face;
  };
  std::vector<Candidate> candidates;
  for (size_t r = 0; r + 1 < runs.starts.size(); ++r) {
    const uint32_t begin = runs.starts[r];
    const uint32_t end = runs.starts[r + 1];
    uint32_t forward = 0;
    for (uint32_t k = begin; k < end; ++k)
      forward += mesh.origin[runs.half_edges[k]] < mesh.tip(runs.half_edges[k]) ? 1 : 0;
    if (forward < 2 && end - begin - forward < 2) continue;
    for (uint32_t k = begin; k < end; ++k) {
      uint32_t h = Topology::face(runs.half_edges[k]) * 3;
      for (int turn = 0; turn < 2 && mesh.origin[h] > std::min(mesh.tip(h), mesh.apex(h)); ++turn) ++h;
      candidates.push_back({{mesh.origin[h], mesh.tip(h), mesh.apex(h)}, Topology::face(h)});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
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
  for (uint32_t f = 0; f < repeated.size(); ++f) {
    if (repeated[f]) continue;
    std::copy_n(mesh.origin.begin() + 3 * f, 3, mesh.origin.begin() + 3 * kept);
    if (!corner_point.empty()) std::copy_n(corner_point.begin() + 3 * f, 3, corner_point.begin() + 3 * kept);
    ++kept;
  }
  mesh.origin.resize_for_overwrite(size_t{3} * kept);
  if (!corner_point.empty()) corner_point.resize(mesh.origin.size());
  return dropped;
}

/// Finds twins; numbers edges in the order of their first half-edge, so that they lie in memory as the faces do.
class Connector {
 public:
  Connector(Topology& mesh, const EdgeRuns& runs, BuildReport& report) : mesh_(mesh), runs_(runs), report_(report) {}

  void run() {
    const uint32_t count = mesh_.half_edge_count();
    mesh_.twin.assign(count, none);
    find_twins();
    mesh_.edge.resize_for_overwrite(count);
    mesh_.half_edge.resize_for_overwrite(runs_.starts.size() - 1);
    mesh_.kind.assign(mesh_.half_edge.size(), EdgeKind::smooth);
    uint32_t edges = 0;
    for (uint32_t h = 0; h < count; ++h) {
      const uint32_t t = mesh_.twin[h];
      if (t == none ? !is_first_on_curve(h) : t < h) continue;
      mesh_.half_edge[edges] = h;
      mesh_.edge[h] = edges;
      if (t == none)
        number_curve(h, edges);
      else
        mesh_.edge[t] = edges;
      ++edges;
    }
  }

 private:
  void find_twins() {
    for (uint32_t r = 0; r + 1 < runs_.starts.size(); ++r) {
      const uint32_t first = runs_.half_edges[runs_.starts[r]];
      if (runs_.starts[r + 1] - runs_.starts[r] == 2) {
        const uint32_t second = runs_.half_edges[runs_.starts[r] + 1];
        if (mesh_.origin[first] != mesh_.origin[second]) {
          mesh_.twin[first] = second;
          mesh_.twin[second] = first;
          continue;
        }
      }
      if (curve_.empty()) curve_.assign(mesh_.half_edge_count(), none);
      curve_[first] = r;
    }
  }

  [[nodiscard]] bool is_first_on_curve(uint32_t h) const { return curve_[h] != none; }

  /// The edge of half-edge `first` and of those that have no twin because of what lies there.
  void number_curve(uint32_t first, uint32_t edge) {
    const uint32_t begin = runs_.starts[curve_[first]];
    const uint32_t end = runs_.starts[curve_[first] + 1];
    for (uint32_t k = begin; k < end; ++k) mesh_.edge[runs_.half_edges[k]] = edge;
    mesh_.kind[edge] = end - begin == 1 ? EdgeKind::boundary : EdgeKind::shared;
    uint32_t& found = end - begin == 1   ? report_.boundary_edges
                      : end - begin == 2 ? report_.misoriented_edges
                                         : report_.non_manifold_edges;
    ++found;
  }

  Topology& mesh_;
  const EdgeRuns& runs_;
  BuildReport& report_;
  Buffer<uint32_t> curve_;  ///< [H] of an edge without twins, at its first half-edge: its run; empty if there is none
};

/// The same in one pass, where every edge has one face, or two that are wound alike, as most meshes have it: edges that
/// are known are looked up in a list at their lower vertex. False, and to be done again by the other, where one has
/// more, or such a list is too long to be gone through for every edge.
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
      for (uint32_t h = first; h < first + 3; ++h)
        if (!add(h, mesh_.origin[h], mesh_.origin[h == first + 2 ? first : h + 1])) return false;
    mesh_.half_edge.resize_for_overwrite(edges_);
    mesh_.kind.assign(edges_, EdgeKind::smooth);
    if (2 * size_t{edges_} == count) return true;
    for (uint32_t e = 0; e < edges_; ++e) {
      if (mesh_.twin[mesh_.half_edge[e]] != none) continue;
      mesh_.kind[e] = EdgeKind::boundary;
      ++report.boundary_edges;
    }
    return true;
  }

 private:
  struct Known {
    uint32_t higher;  ///< vertex
    uint32_t next;    ///< edge with the same lower vertex; `none`
  };
  static constexpr int most_steps = 32;

  bool add(uint32_t h, uint32_t from, uint32_t to) {
    uint32_t& first = first_at_[std::min(from, to)];
    const uint32_t higher = std::max(from, to);
    int steps = 0;
    for (uint32_t e = first; e != none; e = known_[e].next) {
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

  bool join(uint32_t h, uint32_t from, uint32_t e) {
    const uint32_t t = mesh_.half_edge[e];
    if (mesh_.twin[t] != none || mesh_.origin[t] == from) return false;
    mesh_.twin[h] = t;
    mesh_.twin[t] = h;
    mesh_.edge[h] = e;
    return true;
  }

  Topology& mesh_;
  Buffer<uint32_t> first_at_;  ///< [V] an edge of which this is the lower vertex; `none`
  Buffer<Known> known_;        ///< [E]
  uint32_t edges_ = 0;
};

/// How many faces the fan of half-edge h has. Fans end where there is no twin.
uint32_t fan_size(const Topology& mesh, uint32_t h) {
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
  for (Buffer<uint32_t>* of_edges : {&mesh.twin, &mesh.edge, &mesh.half_edge}) of_edges->clear();
  EdgeRuns runs = sort_into_edges(mesh);
  report.repeated_faces = drop_repeated_faces(mesh, runs, corner_point);
  if (report.repeated_faces > 0) runs = sort_into_edges(mesh);
  Connector(mesh, runs, report).run();
}

std::vector<uint32_t> find_pinched(const Topology& mesh) {
  Buffer<uint32_t> corners(mesh.vertex_count, 0);
  auto last = Buffer<uint32_t>::for_overwrite(mesh.vertex_count);
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
    ++corners[mesh.origin[h]];
    last[mesh.origin[h]] = h;
  }
  std::vector<uint32_t> pinched;  // the fan of one corner leaves out another
  for (uint32_t v = 0; v < mesh.vertex_count; ++v)
    if (fan_size(mesh, last[v]) != corners[v]) pinched.push_back(v);
  return pinched;
}

void number_edges(Topology& mesh) {
  if (mesh.has_edges()) return;
  mesh.darts.clear();
  using OpenEnd = std::array<uint32_t, 3>;  // lower vertex, higher vertex, half-edge
  std::vector<OpenEnd> open;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.twin[h] == none)
      open.push_back({std::min(mesh.origin[h], mesh.tip(h)), std::max(mesh.origin[h], mesh.tip(h)), h});
  std::sort(open.begin(), open.end());
  const auto meet = [](const OpenEnd& one, const OpenEnd& other) { return one[0] == other[0] && one[1] == other[1]; };

  mesh.edge.assign(mesh.half_edge_count(), none);
  for (size_t i = 0; i < open.size(); ++i) mesh.edge[open[i][2]] = i > 0 && meet(open[i - 1], open[i]) ? 0 : none;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
    if (mesh.edge[h] != none) continue;
    mesh.edge[h] = mesh.edge_count();
    if (mesh.twin[h] != none) mesh.edge[mesh.twin[h]] = mesh.edge[h];
    mesh.half_edge.push_back(h);
    mesh.kind.push_back(mesh.twin[h] == none ? EdgeKind::boundary : EdgeKind::smooth);
  }
  for (size_t i = 1; i < open.size(); ++i) {
    if (!meet(open[i - 1], open[i])) continue;
    mesh.edge[open[i][2]] = mesh.edge[open[i - 1][2]];
    mesh.kind[mesh.edge[open[i][2]]] = EdgeKind::shared;
  }
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
