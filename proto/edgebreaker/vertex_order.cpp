#include "proto/edgebreaker/vertex_order.h"

#include <vector>

namespace papilio::proto::edgebreaker {
namespace {

class DepthFirst {
 public:
  explicit DepthFirst(const CornerMesh& mesh)
      : mesh_(mesh), visited_(mesh.face_count(), 0), on_boundary_(mesh.vertex_count(), 0) {
    order_.corners.reserve(mesh.vertex_count());
    order_.place.assign(mesh.vertex_count(), none);
    for (uint32_t c = 0; c < mesh.corner_count(); ++c)
      if (mesh.opposite(c) == none)
        on_boundary_[mesh.vertex(CornerMesh::next(c))] = on_boundary_[mesh.vertex(CornerMesh::previous(c))] = 1;
  }

  VertexOrder run(const Array<uint32_t>& starts) {
    for (uint32_t corner : starts)
      if (!is_visited(corner)) walk_from(corner);
    return std::move(order_);
  }

 private:
  void walk_from(uint32_t corner) {
    come_to(CornerMesh::next(corner));
    come_to(CornerMesh::previous(corner));
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

  /// True when the vertex is new.
  bool come_to(uint32_t corner) {
    uint32_t& place = order_.place[mesh_.vertex(corner)];
    if (place != none) return false;
    place = static_cast<uint32_t>(order_.corners.size());
    order_.corners.push_back(corner);
    return true;
  }

  /// The corner to go on with; `none` where the walk ends or falls in two.
  uint32_t visit(uint32_t corner) {
    visited_[CornerMesh::face(corner)] = 1;
    const uint32_t right = mesh_.right(corner);
    if (come_to(corner) && on_boundary_[mesh_.vertex(corner)] == 0) return right;
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
  Array<uint8_t> visited_;      ///< [faces]
  Array<uint8_t> on_boundary_;  ///< [vertices]
  std::vector<uint32_t> stack_;
  VertexOrder order_;
};

}  // namespace

VertexOrder order_vertices(const CornerMesh& mesh, const Array<uint32_t>& starts) {
  return DepthFirst(mesh).run(starts);
}

}  // namespace papilio::proto::edgebreaker
