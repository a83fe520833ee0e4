#include <algorithm>
#include <array>
#include <vector>

#include "proto/edgebreaker/vertex_order.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Walk by prediction degree. Pending corners are in three stacks by priority; the lowest stack comes first.
class PredictionDegreeWalk {
 public:
  PredictionDegreeWalk(const CornerMesh& mesh, Poller& poller)
      : mesh_(mesh),
        poller_(poller),
        face_visited_(mesh.face_count(), 0),
        vertex_visited_(mesh.vertex_count(), 0),
        degree_(mesh.vertex_count(), 0) {
    order_.reserve(mesh.vertex_count());
  }

  Buffer<uint32_t> run(const Buffer<uint32_t>& starts) {
    for (uint32_t corner : starts) {
      if (is_visited(corner)) continue;
      for (uint32_t c : {CornerMesh::next(corner), CornerMesh::previous(corner), corner}) visit_vertex(c);
      push(corner, 0);
      while ((corner = pop()) != none)
        while (corner != none) corner = visit(corner);
    }
    return std::move(order_);
  }

 private:
  static constexpr uint32_t priorities = 3;

  void visit_vertex(uint32_t corner) {
    uint8_t& is_visited = vertex_visited_[mesh_.vertex(corner)];
    if (is_visited == 0) order_.push_back(corner);
    is_visited = 1;
  }

  /// Visits the face of the corner. Returns the next corner; `none` where a pending corner has priority.
  uint32_t visit(uint32_t corner) {
    poller_.step();
    face_visited_[CornerMesh::face(corner)] = 1;
    visit_vertex(corner);
    const uint32_t right = mesh_.right(corner);
    const uint32_t left = mesh_.left(corner);
    const bool right_visited = is_visited(right);
    if (!is_visited(left)) {
      const uint32_t priority = priority_of(left);
      if (right_visited && priority <= best_) return left;
      push(left, priority);
    }
    if (!right_visited) {
      const uint32_t priority = priority_of(right);
      if (priority <= best_) return right;
      push(right, priority);
    }
    return none;
  }

  /// Returns 0 for a visited vertex, 1 for a vertex that several visited faces predict, else 2.
  uint32_t priority_of(uint32_t corner) {
    const uint32_t vertex = mesh_.vertex(corner);
    if (vertex_visited_[vertex] != 0) return 0;
    uint8_t& degree = degree_[vertex];
    degree = std::min(degree + 1, 2);
    return degree > 1 ? 1 : 2;
  }

  void push(uint32_t corner, uint32_t priority) {
    stacks_[priority].push_back(corner);
    best_ = std::min(best_, priority);
  }
  /// Takes the pending corner of the highest priority; `none` where all faces in reach are visited.
  uint32_t pop() {
    for (; best_ < priorities; ++best_)
      for (std::vector<uint32_t>& stack = stacks_[best_]; !stack.empty();) {
        const uint32_t corner = stack.back();
        stack.pop_back();
        if (!is_visited(corner)) return corner;
      }
    best_ = 0;
    return none;
  }

  [[nodiscard]] bool is_visited(uint32_t corner) const {
    return corner == none || face_visited_[CornerMesh::face(corner)] != 0;
  }

  const CornerMesh& mesh_;
  Poller& poller_;
  Buffer<uint8_t> face_visited_;    ///< [faces]
  Buffer<uint8_t> vertex_visited_;  ///< [vertices]
  Buffer<uint8_t> degree_;          ///< [vertices] number of visited faces that predict it, at most 2
  std::array<std::vector<uint32_t>, priorities> stacks_;
  uint32_t best_ = 0;  ///< lowest stack that may hold a corner
  Buffer<uint32_t> order_;
};

}  // namespace

Buffer<uint32_t> order_by_prediction_degree(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Poller& poller) {
  return PredictionDegreeWalk(mesh, poller).run(starts);
}

}  // namespace papilio::proto::edgebreaker
