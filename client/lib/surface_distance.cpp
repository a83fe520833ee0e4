#include "client/lib/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace papilio::client {
namespace {

constexpr uint32_t kLeafTriangles = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d lower(Vec3d a, Vec3d b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3d upper(Vec3d a, Vec3d b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

double squared(Vec3d a) { return dot(a, a); }

}  // namespace

std::optional<Vec3d> unit_normal(const TriangleCorners& triangle) {
  const Vec3d normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const double size = length(normal);
  if (!(size > 0)) return std::nullopt;
  return (1 / size) * normal;
}

SurfaceDistance::SurfaceDistance(std::span<const TriangleCorners> triangles)
    : triangles_(triangles.begin(), triangles.end()) {
  nodes_.reserve(triangles.size());
  build(0, static_cast<uint32_t>(triangles_.size()));
  const auto& [low, high] = nodes_[0].box;
  for (const double coordinate : {low.x, low.y, low.z, high.x, high.y, high.z})
    tie_ = std::max(tie_, 1e-12 * std::abs(coordinate));
}

SurfaceDistance::Nearest SurfaceDistance::nearest(Vec3d point, Vec3d normal) const {
  const double least = distance(point);
  const double reach = (least + tie_) * (least + tie_);
  std::optional<double> cosine;
  walk(
      point, [&] { return reach; },
      [&](const TriangleCorners& triangle) {
        const auto other = unit_normal(triangle);
        if (!other || squared_distance(point, triangle) > reach) return;
        cosine = std::max(cosine.value_or(-1), std::clamp(dot(normal, *other), -1.0, 1.0));
      });
  return {least, cosine};
}

double SurfaceDistance::distance(Vec3d point) const {
  double least = kInfinity;
  walk(
      point, [&] { return least; },
      [&](const TriangleCorners& triangle) { least = std::min(least, squared_distance(point, triangle)); });
  return std::sqrt(least);
}

template <class Reach, class Visit>
void SurfaceDistance::walk(Vec3d point, const Reach& reach, const Visit& visit) const {
  // A box's distance may be rounded above the distance of a triangle that touches it.
  constexpr double kSlack = 1 - 1e-12;
  struct Pending {
    uint32_t node;
    double squared_distance;
  };
  // The tree halves its triangles at each level: at most 32 levels, with one pending node on each.
  std::array<Pending, 64> pending;
  size_t size = 0;
  pending[size++] = {0, squared_distance_to_box(point, nodes_[0].box)};
  while (size > 0) {
    const auto [index, box_distance] = pending[--size];
    if (box_distance * kSlack > reach()) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (uint32_t i = 0; i < node.count; ++i) visit(triangles_[node.first + i]);
      continue;
    }
    Pending near{index + 1, squared_distance_to_box(point, nodes_[index + 1].box)};
    Pending far{node.first, squared_distance_to_box(point, nodes_[node.first].box)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    pending[size++] = far;
    pending[size++] = near;
  }
}

void SurfaceDistance::build(uint32_t begin, uint32_t end) {
  const Box box = bounds(begin, end);
  const size_t index = nodes_.size();
  nodes_.push_back({box, begin, end - begin});
  if (end - begin <= kLeafTriangles) return;

  const Vec3d size = box.high - box.low;
  const auto axis = size.x >= size.y && size.x >= size.z ? &Vec3d::x : size.y >= size.z ? &Vec3d::y : &Vec3d::z;
  const auto centre = [axis](const TriangleCorners& t) { return t.a.*axis + t.b.*axis + t.c.*axis; };
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const TriangleCorners& a, const TriangleCorners& b) { return centre(a) < centre(b); });
  build(begin, middle);
  nodes_[index].first = static_cast<uint32_t>(nodes_.size());
  nodes_[index].count = 0;
  build(middle, end);
}

SurfaceDistance::Box SurfaceDistance::bounds(uint32_t begin, uint32_t end) const {
  Box box{triangles_[begin].a, triangles_[begin].a};
  for (uint32_t i = begin; i < end; ++i)
    for (const Vec3d corner : {triangles_[i].a, triangles_[i].b, triangles_[i].c})
      box = {lower(box.low, corner), upper(box.high, corner)};
  return box;
}

double SurfaceDistance::squared_distance_to_box(Vec3d point, const Box& box) {
  const Vec3d zero;
  return squared(upper(upper(box.low - point, point - box.high), zero));
}

}  // namespace papilio::client
