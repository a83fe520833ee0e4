#include "proto/edgebreaker/vertex_order.h"

#include <vector>

namespace papilio::proto::edgebreaker {
namespace {

/// Depth-first walk.
class DepthFirst {
 public:
  DepthFirst(const CornerMesh& mesh, Poller& poller)
      : mesh_(mesh),
        poller_(poller),
        face_visited_(mesh.face_count(), 0),
        vertex_state_(mesh.vertex_count(), unvisited_inner) {
    order_.corners.reserve(mesh.vertex_count());
    for (uint32_t c : mesh.at_boundary())
      for (uint32_t end : {CornerMesh::next(c), CornerMesh::previous(c)})
        vertex_state_[mesh.vertex(end)] = unvisited_boundary;
  }

  VertexOrder run(const Buffer<uint32_t>& starts) {
    for (uint32_t corner : starts) {
      if (order_.corners.size() == mesh_.vertex_count()) break;  // further faces add nothing
      if (!is_visited(corner)) walk_from(corner);
    }
    return std::move(order_);
  }

 private:
  enum VertexState : uint8_t { unvisited_inner, unvisited_boundary, visited };

  void walk_from(uint32_t corner) {
    for (uint32_t c : {CornerMesh::next(corner), CornerMesh::previous(corner)}) {
      record_if_unpredicted(c);
      (void)visit_vertex(c);
    }
    record_if_unpredicted(corner);
    stack_.assign(1, corner);
    while (!stack_.empty()) {
      corner = stack_.back();
      if (is_visited(corner)) {
        stack_.pop_back();
        continue;
      }
      while (corner != none) corner = visit(corner);
    }
  }

  /// Records an unvisited vertex at the start of a walk that no parallelogram predicts. Vertices that a walk reaches
  /// across an edge always have a parallelogram.
  void record_if_unpredicted(uint32_t corner) {
    const auto is_vertex_visited = [this](uint32_t c) { return vertex_state_[mesh_.vertex(c)] == visited; };
    if (is_vertex_visited(corner)) return;
    const uint32_t opposite = mesh_.opposite(corner);
    if (opposite == none || !is_vertex_visited(opposite) || !is_vertex_visited(CornerMesh::next(opposite)) ||
        !is_vertex_visited(CornerMesh::previous(opposite)))
      order_.unpredicted.push_back(static_cast<uint32_t>(order_.corners.size()));
  }

  /// Appends the corner's vertex to the order unless it is visited. Returns the state of the vertex before.
  VertexState visit_vertex(uint32_t corner) {
    uint8_t& state = vertex_state_[mesh_.vertex(corner)];
    const auto before = static_cast<VertexState>(state);
    if (before != visited) order_.corners.push_back(corner);
    state = visited;
    return before;
  }

  /// Visits the face of the corner. Returns the next corner; `none` where the walk ends or splits.
  uint32_t visit(uint32_t corner) {
    face_visited_[CornerMesh::face(corner)] = 1;
    poller_.step();
    const uint32_t right = mesh_.right(corner);
    mesh_.prefetch(right);
    mesh_.prefetch(mesh_.left(corner));
    if (visit_vertex(corner) == unvisited_inner) return right;
    const uint32_t left = mesh_.left(corner);
    const bool right_visited = is_visited(right);
    const bool left_visited = is_visited(left);
    if (right_visited && left_visited) {
      stack_.pop_back();
      return none;
    }
    if (right_visited) return left;
    if (left_visited) return right;
    stack_.back() = left;
    stack_.push_back(right);
    return none;
  }

  [[nodiscard]] bool is_visited(uint32_t corner) const {
    return corner == none || face_visited_[CornerMesh::face(corner)] != 0;
  }

  const CornerMesh& mesh_;
  Poller& poller_;
  Buffer<uint8_t> face_visited_;  ///< [faces]
  Buffer<uint8_t> vertex_state_;  ///< [vertices] VertexState
  std::vector<uint32_t> stack_;
  VertexOrder order_;
};

}  // namespace

VertexOrder order_vertices(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Poller& poller) {
  return DepthFirst(mesh, poller).run(starts);
}

}  // namespace papilio::proto::edgebreaker
