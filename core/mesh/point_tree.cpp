#include "mesh/point_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

constexpr uint32_t leaf_size = 8;
constexpr uint64_t steps_a_point = 128, least_steps = 1 << 20, most_steps_of_all = 1 << 28;
constexpr uint64_t steps_of_a_visit = 8;

double along(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Returns whether the segment from a to b meets the box, widened by `distance` (Kay and Kajiya's slabs).
bool meets(Vec3d a, Vec3d b, Vec3d min, Vec3d max, double distance) {
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = along(a, axis), step = along(b, axis) - from;
    const double low = along(min, axis) - distance - from, high = along(max, axis) + distance - from;
    if (step == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    first = std::max(first, std::min(low / step, high / step));
    last = std::min(last, std::max(low / step, high / step));
  }
  return first <= last;
}

}  // namespace

PointTree::PointTree(std::vector<Vec3d> points)
    : points_(std::move(points)),
      order_(points_.size()),
      most_steps_(std::min(steps_a_point * points_.size() + least_steps, most_steps_of_all)) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!points_.empty()) build(0, static_cast<uint32_t>(points_.size()));
}

int PointTree::bound(Node& node) const {
  node.min = node.max = points_[order_[node.begin]];
  for (uint32_t k = node.begin; k < node.end; ++k) {
    const Vec3d p = points_[order_[k]];
    node.min = {std::min(node.min.x, p.x), std::min(node.min.y, p.y), std::min(node.min.z, p.z)};
    node.max = {std::max(node.max.x, p.x), std::max(node.max.y, p.y), std::max(node.max.z, p.z)};
  }
  const Vec3d size = node.max - node.min;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

uint32_t PointTree::build(uint32_t begin, uint32_t end) {
  const auto number = static_cast<uint32_t>(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  const int axis = bound(node);
  nodes_.push_back(node);
  if (end - begin <= leaf_size) return number;
  const uint32_t middle = begin + (end - begin) / 2;
  const auto at = [&](uint32_t k) { return order_.begin() + k; };
  std::nth_element(at(begin), at(middle), at(end), [&](uint32_t p, uint32_t q) {
    const double a = along(points_[p], axis), b = along(points_[q], axis);
    return a != b ? a < b : p < q;
  });
  build(begin, middle);
  nodes_[number].right = build(middle, end);
  return number;
}

void PointTree::for_each_near(Vec3d a, Vec3d b, double distance, const std::function<bool(uint32_t)>& visit) {
  std::array<uint32_t, 64> stack{};  // deeper than a balanced tree of 2^32 points
  size_t waiting = nodes_.empty() ? 0 : 1;
  while (waiting > 0) {
    const uint32_t number = stack[--waiting];
    const Node& node = nodes_[number];
    if (++steps_ > most_steps_) return;
    if (!meets(a, b, node.min, node.max, distance)) continue;
    if (node.right != 0) {
      stack[waiting++] = node.right;
      stack[waiting++] = number + 1;
      continue;
    }
    steps_ += node.end - node.begin;
    for (uint32_t k = node.begin; k < node.end; ++k) {
      if (squared_distance_to_segment(points_[order_[k]], a, b) > distance * distance) continue;
      steps_ += steps_of_a_visit;
      if (!visit(order_[k])) return;
    }
  }
}

}  // namespace papilio
