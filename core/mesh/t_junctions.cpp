#include "mesh/t_junctions.h"

#include <algorithm>
#include <utility>

#include "base/sort.h"
#include "mesh/point_tree.h"
#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

constexpr size_t most_candidates = 4096;       // upper bound near an edge
constexpr ptrdiff_t most_boundary_edges = 16;  // upper bound of those examined at a vertex

/// Boundary half-edges by one of their vertices.
class EdgesAt {
 public:
  void add(VertexId vertex, uint32_t half_edge) { edges_.emplace_back(vertex, half_edge); }
  void sort() { sort_range(edges_); }
  /// Returns whether the predicate holds of any half-edge at the vertex.
  template <class Predicate>
  [[nodiscard]] bool any(VertexId vertex, Predicate is) const {
    auto edge = std::ranges::lower_bound(edges_, uint32_t{vertex}, {}, &std::pair<uint32_t, uint32_t>::first);
    for (ptrdiff_t looks = 0; edge != edges_.end() && edge->first == vertex && looks < most_boundary_edges; ++looks)
      if (is((edge++)->second)) return true;
    return false;
  }

 private:
  std::vector<std::pair<uint32_t, uint32_t>> edges_;
};

class TJunctionFinder {
 public:
  TJunctionFinder(const Topology& mesh, const Buffer<Vec3f>& positions, double distance)
      : mesh_(mesh), positions_(positions), distance_(distance) {
    for (const HalfEdgeId h : mesh.half_edge) {
      if (mesh.kind[mesh.edge[h]] != EdgeKind::boundary) continue;
      open_.push_back(h);
      leaving_.add(mesh.origin[h], h);
      arriving_.add(mesh.tip(h), h);
      vertices_.push_back(mesh.origin[h]);
    }
    leaving_.sort();
    arriving_.sort();
    sort_range(vertices_);
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  std::vector<Insertion> run() {
    std::vector<Vec3d> points;
    for (const VertexId v : vertices_) points.push_back(at(v));
    PointTree tree(std::move(points));
    std::vector<Insertion> found;
    for (const HalfEdgeId h : open_) {
      append_of(h, tree, found);
      if (tree.is_exhausted() || found.size() >= open_.size()) break;
    }
    return found;
  }

 private:
  [[nodiscard]] Vec3d at(VertexId vertex) const { return to_double(positions_[vertex]); }

  void append_of(HalfEdgeId h, PointTree& tree, std::vector<Insertion>& found) const {
    const Vec3d a = at(mesh_.origin[h]), b = at(mesh_.tip(h));
    std::vector<Insertion> on_edge;
    tree.for_each_near(a, b, distance_, [&](uint32_t number) {
      const VertexId v = vertices_[number];
      if (is_apart(v, h) && connects(v, h)) on_edge.push_back({h, dot(at(v) - a, b - a) / dot(b - a, b - a), v});
      return on_edge.size() < most_candidates;
    });
    sort_range(on_edge, [](const Insertion& one, const Insertion& other) {
      return one.share != other.share ? one.share < other.share : one.vertex < other.vertex;
    });
    Vec3d last = a;
    for (const Insertion& insertion : on_edge) {
      if (!is_farther(at(insertion.vertex), last)) continue;
      last = at(insertion.vertex);
      found.push_back(insertion);
    }
  }

  [[nodiscard]] bool is_farther(Vec3d p, Vec3d q) const { return dot(p - q, p - q) > distance_ * distance_; }

  /// Returns whether a vertex is no corner of h's face, and apart from both ends of h's edge.
  [[nodiscard]] bool is_apart(VertexId v, HalfEdgeId h) const {
    return v != mesh_.origin[h] && v != mesh_.tip(h) && v != mesh_.apex(h) && is_farther(at(v), at(mesh_.origin[h])) &&
           is_farther(at(v), at(mesh_.tip(h)));
  }

  /// Returns whether a boundary edge at the vertex runs along the edge of h in the opposite direction.
  [[nodiscard]] bool connects(VertexId v, HalfEdgeId h) const {
    const auto runs_to = [&](uint32_t g, uint32_t one, uint32_t other) {
      return Topology::face(g) != h.face() && lie_in_one_direction(v, one, other);
    };
    return leaving_.any(v, [&](uint32_t g) { return runs_to(g, mesh_.tip(g), mesh_.origin[h]); }) ||
           arriving_.any(v, [&](uint32_t g) { return runs_to(g, mesh_.origin[g], mesh_.tip(h)); });
  }

  /// Returns whether one of two vertices lies on the way from v to the other.
  [[nodiscard]] bool lie_in_one_direction(VertexId v, uint32_t one, uint32_t other) const {
    if (!is_farther(at(v), at(one))) return false;
    const double most = distance_ * distance_;
    return squared_distance_to_segment(at(one), at(v), at(other)) <= most ||
           squared_distance_to_segment(at(other), at(v), at(one)) <= most;
  }

  const Topology& mesh_;
  const Buffer<Vec3f>& positions_;
  const double distance_;
  std::vector<uint32_t> open_;      ///< half-edges at the boundary
  std::vector<uint32_t> vertices_;  ///< boundary vertices in ascending order
  EdgesAt leaving_, arriving_;
};

}  // namespace

std::vector<Insertion> find_t_junctions(const Topology& mesh, const Buffer<Vec3f>& positions, double distance) {
  return TJunctionFinder(mesh, positions, distance).run();
}

}  // namespace papilio
