#include <algorithm>
#include <array>
#include <vector>

#include "proto/edgebreaker/vertex_order.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Corners still to be walked to are in three stacks; those of the lowest come first.
class ByPredictionDegree {
 public:
  ByPredictionDegree(const CornerMesh& mesh, Pace& pace)
      : mesh_(mesh),
        pace_(pace),
        visited_(mesh.face_count(), 0),
        known_(mesh.vertex_count(), 0),
        degree_(mesh.vertex_count(), 0) {
    order_.reserve(mesh.vertex_count());
  }

  Buffer<uint32_t> run(const Buffer<uint32_t>& starts) {
    for (uint32_t corner : starts) {
      if (is_visited(corner)) continue;
      for (uint32_t c : {CornerMesh::next(corner), CornerMesh::previous(corner), corner}) come_to(c);
      push(corner, 0);
      while ((corner = pop()) != none)
        while (corner != none) corner = visit(corner);
    }
    return std::move(order_);
  }

 private:
  static constexpr uint32_t priorities = 3;

  void come_to(uint32_t corner) {
    uint8_t& known = known_[mesh_.vertex(corner)];
    if (known == 0) order_.push_back(corner);
    known = 1;
  }

  /// The corner to go on with; `none` where others come first.
  uint32_t visit(uint32_t corner) {
    pace_.step();
    visited_[CornerMesh::face(corner)] = 1;
    come_to(corner);
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

  /// 0 to a vertex that is known, 1 to one that was come across before, else 2.
  uint32_t priority_of(uint32_t corner) {
    const uint32_t vertex = mesh_.vertex(corner);
    if (known_[vertex] != 0) return 0;
    uint8_t& degree = degree_[vertex];
    degree = std::min(degree + 1, 2);
    return degree > 1 ? 1 : 2;
  }

  void push(uint32_t corner, uint32_t priority) {
    stacks_[priority].push_back(corner);
    best_ = std::min(best_, priority);
  }
  /// `none` where every face that can be reached has been visited.
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
    return corner == none || visited_[CornerMesh::face(corner)] != 0;
  }

  const CornerMesh& mesh_;
  Pace& pace_;
  Buffer<uint8_t> visited_;  ///< [faces]
  Buffer<uint8_t> known_;    ///< [vertices] whether it is in the order
  Buffer<uint8_t> degree_;   ///< [vertices] how often a face beyond which it lies was seen: 0, 1, or 2 for more
  std::array<std::vector<uint32_t>, priorities> stacks_;
  uint32_t best_ = 0;  ///< the lowest stack that may hold a corner
  Buffer<uint32_t> order_;
};

}  // namespace

Buffer<uint32_t> order_by_prediction_degree(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Pace& pace) {
  return ByPredictionDegree(mesh, pace).run(starts);
}

}  // namespace papilio::proto::edgebreaker
