#include "detail/surface_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace papilio {
namespace {

constexpr uint32_t most_in_leaf = 4;
constexpr double least_normal_cosine = 0.25;

float coordinate(Vec3f p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Returns the nearest point of a triangle [Ericson, Real-Time Collision Detection, 5.1.5].
Vec3d nearest_point(Vec3d p, const TriangleCorners& t) {
  const Vec3d ab = t.b - t.a;
  const Vec3d ac = t.c - t.a;
  const Vec3d ap = p - t.a;
  const double d1 = dot(ab, ap);
  const double d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const Vec3d bp = p - t.b;
  const double d3 = dot(ab, bp);
  const double d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + (d1 / (d1 - d3)) * ab;
  const Vec3d cp = p - t.c;
  const double d5 = dot(ab, cp);
  const double d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return t.b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t.c - t.b);
  const double sum = va + vb + vc;
  if (!(sum > 0)) return t.a;
  return t.a + (vb / sum) * ab + (vc / sum) * ac;
}

void include(Box& box, Vec3f p) {
  box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
  box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
}

}  // namespace

SurfaceTree::SurfaceTree(TriangleMesh surface) : surface_(std::move(surface)), order_(surface_.triangles.size()) {
  std::vector<Vec3f> centres;
  for (uint32_t f = 0; f < order_.size(); ++f) {
    const auto [a, b, c] = corners(f);
    const Vec3d normal = cross(b - a, c - a);
    const double size = length(normal);
    normals_.push_back(size > 0 ? to_float((1 / size) * normal) : Vec3f{});
    centres.push_back(to_float((1 / 3.0) * (a + b + c)));
  }
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(order_.size() + 1);
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(order_.size()), centres);
}

TriangleCorners SurfaceTree::corners(uint32_t face) const {
  const Triangle& t = surface_.triangles[face];
  return {to_double(surface_.positions[t[0]]), to_double(surface_.positions[t[1]]),
          to_double(surface_.positions[t[2]])};
}

void SurfaceTree::build(uint32_t node, uint32_t first, uint32_t last, const std::vector<Vec3f>& centres) {
  Box box = bounding_box({});
  Box of_centres = box;
  for (uint32_t i = first; i < last; ++i) {
    for (const uint32_t v : surface_.triangles[order_[i]]) include(box, surface_.positions[v]);
    include(of_centres, centres[order_[i]]);
  }
  nodes_[node] = {box.min, box.max, first, last - first};
  if (last - first <= most_in_leaf) return;
  const Vec3f size = of_centres.max - of_centres.min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](uint32_t a, uint32_t b) {
    const float ca = coordinate(centres[a], axis);
    const float cb = coordinate(centres[b], axis);
    return ca != cb ? ca < cb : a < b;
  });
  const auto left = static_cast<uint32_t>(nodes_.size());
  nodes_[node].first = left;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(left, first, middle, centres);
  build(left + 1, middle, last, centres);
}

double SurfaceTree::squared_distance_to(const Node& node, Vec3d p) {
  const double x = std::max({node.min.x - p.x, 0.0, p.x - node.max.x});
  const double y = std::max({node.min.y - p.y, 0.0, p.y - node.max.y});
  const double z = std::max({node.min.z - p.z, 0.0, p.z - node.max.z});
  return x * x + y * y + z * z;
}

Nearest SurfaceTree::nearest(Vec3d point, double reach, Vec3d normal) const {
  const bool all = normal == Vec3d{};
  Nearest found;
  found.squared_distance = reach * reach;
  struct Entry {
    double distance;
    uint32_t node;
  };
  std::array<Entry, 128> stack;
  size_t size = 0;
  stack[size++] = {squared_distance_to(nodes_[0], point), 0};
  while (size > 0) {
    const auto [distance, n] = stack[--size];
    if (distance >= found.squared_distance) continue;
    const Node& node = nodes_[n];
    if (node.count == 0) {
      const double left = squared_distance_to(nodes_[node.first], point);
      const double right = squared_distance_to(nodes_[node.first + 1], point);
      const Entry near{std::min(left, right), left <= right ? node.first : node.first + 1};
      const Entry far{std::max(left, right), left <= right ? node.first + 1 : node.first};
      if (far.distance < found.squared_distance) stack[size++] = far;
      if (near.distance < found.squared_distance) stack[size++] = near;
      continue;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const uint32_t f = order_[i];
      if (!all && !(dot(to_double(normals_[f]), normal) > least_normal_cosine)) continue;
      const Vec3d at = nearest_point(point, corners(f));
      const double d = dot(at - point, at - point);
      if (d < found.squared_distance) found = {d, f, at};
    }
  }
  return found;
}

}  // namespace papilio
