#include "proto/edgebreaker/vertex_order.h"

#include <vector>

namespace papilio::proto::edgebreaker {
namespace {

class DepthFirst {
 public:
  DepthFirst(const CornerMesh& mesh, Pace& pace)
      : mesh_(mesh), pace_(pace), visited_(mesh.face_count(), 0), known_(mesh.vertex_count(), is_new) {
    order_.corners.reserve(mesh.vertex_count());
    for (uint32_t c : mesh.at_boundary())
      known_[mesh.vertex(CornerMesh::next(c))] = known_[mesh.vertex(CornerMesh::previous(c))] = is_new_on_boundary;
  }

  VertexOrder run(const Buffer<uint32_t>& starts) {
    for (uint32_t corner : starts) {
      if (order_.corners.size() == mesh_.vertex_count()) break;  // so has every face been visited, or says no more
      if (!is_visited(corner)) walk_from(corner);
    }
    return std::move(order_);
  }

 private:
  enum Known : uint8_t { is_new, is_new_on_boundary, is_known };

  void walk_from(uint32_t corner) {
    for (uint32_t c : {CornerMesh::next(corner), CornerMesh::previous(corner)}) {
      note_if_alone(c);
      (void)come_to(c);
    }
    note_if_alone(corner);
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

  /// For the vertices that no walk comes to across an edge.
  void note_if_alone(uint32_t corner) {
    const auto is_vertex_known = [this](uint32_t c) { return known_[mesh_.vertex(c)] == is_known; };
    if (is_vertex_known(corner)) return;
    const uint32_t beyond = mesh_.opposite(corner);
    if (beyond == none || !is_vertex_known(beyond) || !is_vertex_known(CornerMesh::next(beyond)) ||
        !is_vertex_known(CornerMesh::previous(beyond)))
      order_.alone.push_back(static_cast<uint32_t>(order_.corners.size()));
  }

  /// What was known of the vertex before.
  Known come_to(uint32_t corner) {
    uint8_t& known = known_[mesh_.vertex(corner)];
    const auto before = static_cast<Known>(known);
    if (before != is_known) order_.corners.push_back(corner);
    known = is_known;
    return before;
  }

  /// The corner to go on with; `none` where the walk ends or falls in two.
  uint32_t visit(uint32_t corner) {
    visited_[CornerMesh::face(corner)] = 1;
    pace_.step();
    const uint32_t right = mesh_.right(corner);
    mesh_.prefetch(right);
    mesh_.prefetch(mesh_.left(corner));
    if (come_to(corner) == is_new) return right;
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
    return corner == none || visited_[CornerMesh::face(corner)] != 0;
  }

  const CornerMesh& mesh_;
  Pace& pace_;
  Buffer<uint8_t> visited_;  ///< [faces]
  Buffer<uint8_t> known_;    ///< [vertices] Known
  std::vector<uint32_t> stack_;
  VertexOrder order_;
};

}  // namespace

VertexOrder order_vertices(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Pace& pace) {
  return DepthFirst(mesh, pace).run(starts);
}

}  // namespace papilio::proto::edgebreaker
