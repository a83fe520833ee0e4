#include "detail/chart_search.h"

#include <algorithm>
#include <array>
#include <limits>

#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

/// Number of successive faces that are no nearer, after which a search ends.
constexpr int most_misses = 12;

/// Returns the weights of a triangle's corners at its point nearest to p.
std::array<double, 3> nearest_weights(Vec3d p, const TriangleCorners& t) {
  const auto along = [&](Vec3d from, Vec3d to) {  // place of the nearest point on a side, 0..1
    const Vec3d way = to - from;
    const double squared = dot(way, way);
    return squared > 0 ? std::clamp(dot(p - from, way) / squared, 0.0, 1.0) : 0.0;
  };
  const Vec3d normal = cross(t.b - t.a, t.c - t.a);
  const double squared = dot(normal, normal);
  if (squared > 0) {
    const double wa = dot(normal, cross(t.b - p, t.c - p)) / squared;
    const double wb = dot(normal, cross(t.c - p, t.a - p)) / squared;
    if (wa >= 0 && wb >= 0 && wa + wb <= 1) return {wa, wb, 1 - wa - wb};
  }
  const double ab = along(t.a, t.b);
  const double bc = along(t.b, t.c);
  const double ca = along(t.c, t.a);
  const std::array<std::array<double, 3>, 3> sides{{{1 - ab, ab, 0}, {0, 1 - bc, bc}, {ca, 0, 1 - ca}}};
  return *std::ranges::min_element(sides, {}, [&](const std::array<double, 3>& w) {
    const Vec3d way = w[0] * t.a + w[1] * t.b + w[2] * t.c - p;
    return dot(way, way);
  });
}

}  // namespace

ChartSearch::ChartSearch(const OriginalSurface& original)
    : original_(original),
      is_seam_(original.mesh().topology.edge_count()),
      seen_(original.mesh().topology.face_count(), 0) {
  for (const uint32_t e : original.seam_edges()) is_seam_[e] = true;
}

ChartSearch::Found ChartSearch::nearest(std::span<const uint32_t> starts, Vec3d point) {
  const Topology& t = original_.mesh().topology;
  const auto is_farther = [](const Candidate& a, const Candidate& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance > b.squared_distance : a.face > b.face;
  };
  ++search_;
  queue_.clear();
  for (const uint32_t face : starts)
    if (face != none) push(face, point);
  std::ranges::make_heap(queue_, is_farther);
  Candidate best{std::numeric_limits<double>::infinity(), none};
  for (int misses = 0; !queue_.empty() && misses < most_misses;) {
    std::ranges::pop_heap(queue_, is_farther);
    const Candidate next = queue_.back();
    queue_.pop_back();
    const bool is_nearer = best.face == none || next.squared_distance < best.squared_distance;
    misses = is_nearer ? 0 : misses + 1;
    if (is_nearer) best = next;
    if (best.squared_distance == 0) break;
    for (uint32_t h = 3 * next.face; h < 3 * next.face + 3; ++h) {
      if (t.twin[h] == none || is_seam_[t.edge[h]]) continue;
      const size_t before = queue_.size();
      push(Topology::face(t.twin[h]), point);
      if (queue_.size() > before) std::ranges::push_heap(queue_, is_farther);
    }
  }
  return {best.face, nearest_weights(point, original_.tree().corners(best.face))};
}

void ChartSearch::push(uint32_t face, Vec3d point) {
  if (seen_[face] == search_) return;
  seen_[face] = search_;
  queue_.push_back({squared_distance(point, original_.tree().corners(face)), face});
}

}  // namespace papilio
