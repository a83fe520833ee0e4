#include "detail/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace papilio {
namespace {

double fraction(double x) { return x - std::floor(x); }

/// Calls visit(point) for samples of a surface. In a triangle they follow the plastic number's sequence, folded at the
/// diagonal [Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018].
template <class Visit>
void for_each_sample(const SurfaceTree& surface, uint32_t samples, const Visit& visit) {
  const auto faces = static_cast<uint32_t>(surface.surface().triangles.size());
  const auto area = [&](const TriangleCorners& c) { return length(cross(c.b - c.a, c.c - c.a)); };
  double total = 0;
  for (uint32_t f = 0; f < faces; ++f) total += area(surface.corners(f));
  double sum = 0;
  uint32_t taken = 0;
  for (uint32_t f = 0; f < faces; ++f) {
    const TriangleCorners c = surface.corners(f);
    sum += area(c);
    for (; taken < samples && sum * samples > (taken + 0.5) * total; ++taken) {
      double u = fraction(0.5 + taken * 0.7548776662466927);
      double v = fraction(0.5 + taken * 0.5698402909980532);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      visit(c.a + u * (c.b - c.a) + v * (c.c - c.a));
    }
  }
}

void measure(const SurfaceTree& from, const SurfaceTree& to, uint32_t samples, SurfaceDistance& found) {
  double sum = 0, largest = 0;
  for_each_sample(from, samples, [&](Vec3d point) {
    const double squared = to.nearest(point).squared_distance;
    sum += squared;
    largest = std::max(largest, squared);
  });
  found.rms = std::max(found.rms, std::sqrt(sum / samples));
  found.largest = std::max(found.largest, std::sqrt(largest));
}

double largest_at_vertices(const SurfaceTree& from, const SurfaceTree& to) {
  const TriangleMesh& surface = from.surface();
  std::vector<bool> is_done(surface.positions.size());
  double largest = 0;
  for (const Triangle& triangle : surface.triangles)
    for (const uint32_t v : triangle) {
      if (is_done[v]) continue;
      is_done[v] = true;
      largest = std::max(largest, to.nearest(to_double(surface.positions[v])).squared_distance);
    }
  return std::sqrt(largest);
}

}  // namespace

SurfaceDistance surface_distance(const SurfaceTree& a, const SurfaceTree& b, uint32_t samples) {
  SurfaceDistance found;
  measure(a, b, samples, found);
  measure(b, a, samples, found);
  return found;
}

double vertex_distance(const SurfaceTree& a, const SurfaceTree& b) {
  return std::max(largest_at_vertices(a, b), largest_at_vertices(b, a));
}

}  // namespace papilio
