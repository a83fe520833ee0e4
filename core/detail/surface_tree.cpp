#include "detail/surface_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "simd/extremes.h"

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

SurfaceTree::SurfaceTree(TriangleMesh surface) : surface_(std::move(surface)) {
  const auto faces = static_cast<uint32_t>(surface_.triangles.size());
  normals_.reserve(faces);
  std::vector<Centre> centres;
  centres.reserve(faces);
  for (uint32_t f = 0; f < faces; ++f) {
    const auto [a, b, c] = corners(f);
    const Vec3d normal = cross(b - a, c - a);
    const double size = length(normal);
    normals_.push_back(size > 0 ? to_float((1 / size) * normal) : Vec3f{});
    centres.push_back({to_float((1 / 3.0) * (a + b + c)), f});
  }
  leaves_.reserve(faces);
  pairs_.reserve(faces / 2 + 1);
  root_ = build(centres);
}

TriangleCorners SurfaceTree::corners(uint32_t face) const {
  const Triangle& t = surface_.triangles[face];
  return {to_double(surface_.positions[t[0]]), to_double(surface_.positions[t[1]]),
          to_double(surface_.positions[t[2]])};
}

SurfaceTree::Node SurfaceTree::build(std::span<Centre> centres) {
  const auto count = static_cast<uint32_t>(centres.size());
  if (count <= most_in_leaf) {
    Box box = bounding_box({});
    const auto first = static_cast<uint32_t>(leaves_.size());
    for (const auto& [at, face] : centres) {
      const Triangle& t = surface_.triangles[face];
      leaves_.push_back({surface_.positions[t[0]], surface_.positions[t[1]], surface_.positions[t[2]], face});
      for (const uint32_t v : t) include(box, surface_.positions[v]);
    }
    return {box.min, box.max, first, count};
  }
  Box of_centres = bounding_box({});
  for (const Centre& centre : centres) include(of_centres, centre.at);
  const Vec3f size = of_centres.max - of_centres.min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t half = count / 2;
  std::nth_element(centres.begin(), centres.begin() + half, centres.end(), [&](const Centre& a, const Centre& b) {
    const float ca = coordinate(a.at, axis);
    const float cb = coordinate(b.at, axis);
    return ca != cb ? ca < cb : a.face < b.face;
  });
  const auto pair = static_cast<uint32_t>(pairs_.size());
  pairs_.emplace_back();
  const Node left = build(centres.first(half));
  const Node right = build(centres.subspan(half));
  pairs_[pair] = {{left, right}};
  Box box{left.min, left.max};
  include(box, right.min);
  include(box, right.max);
  return {box.min, box.max, pair, 0};
}

Nearest SurfaceTree::nearest(Vec3d point, double reach, Vec3d normal) const {
  const bool all = normal == Vec3d{};
  Nearest found;
  found.squared_distance = reach * reach;
  const auto squared_distance_to = [point](const Node& node) {
    const double x = larger(larger(node.min.x - point.x, 0.0), point.x - node.max.x);
    const double y = larger(larger(node.min.y - point.y, 0.0), point.y - node.max.y);
    const double z = larger(larger(node.min.z - point.z, 0.0), point.z - node.max.z);
    return x * x + y * y + z * z;
  };
  struct Entry {
    double distance;
    const Node* node;
  };
  std::array<Entry, 128> stack;
  size_t size = 0;
  stack[size++] = {squared_distance_to(root_), &root_};
  while (size > 0) {
    const auto [distance, node] = stack[--size];
    if (distance >= found.squared_distance) continue;
    if (node->count == 0) {
      const auto& [left, right] = pairs_[node->first].children;
      Entry near{squared_distance_to(left), &left};
      Entry far{squared_distance_to(right), &right};
      if (far.distance < near.distance) std::swap(near, far);
      if (far.distance < found.squared_distance) stack[size++] = far;
      if (near.distance < found.squared_distance) stack[size++] = near;
      continue;
    }
    for (uint32_t i = node->first; i < node->first + node->count; ++i) {
      const auto& [a, b, c, face] = leaves_[i];
      if (!all && !(dot(to_double(normals_[face]), normal) > least_normal_cosine)) continue;
      const Vec3d at = nearest_point(point, {to_double(a), to_double(b), to_double(c)});
      const double d = dot(at - point, at - point);
      if (d < found.squared_distance) found = {d, face, at};
    }
  }
  return found;
}

}  // namespace papilio
