#include "detail/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "detail/surface_samples.h"

namespace papilio {
namespace {

void measure(const SurfaceTree& from, const SurfaceTree& to, uint32_t samples, const Poller& poller,
             SurfaceDistance& found) {
  double sum = 0, largest = 0;
  for_each_sample(from, samples, [&](uint32_t, Vec3d point) {
    poller.step();
    const double squared = to.nearest(point).squared_distance;
    sum += squared;
    largest = std::max(largest, squared);
  });
  found.rms = std::max(found.rms, std::sqrt(sum / samples));
  found.largest = std::max(found.largest, std::sqrt(largest));
}

double largest_at_vertices(const SurfaceTree& from, const SurfaceTree& to, const Poller& poller) {
  const TriangleMesh& surface = from.surface();
  std::vector<bool> is_done(surface.positions.size());
  double largest = 0;
  for (const Triangle& triangle : surface.triangles)
    for (const uint32_t v : triangle) {
      if (is_done[v]) continue;
      is_done[v] = true;
      poller.step();
      largest = std::max(largest, to.nearest(to_double(surface.positions[v])).squared_distance);
    }
  return std::sqrt(largest);
}

}  // namespace

SurfaceDistance surface_distance(const SurfaceTree& a, const SurfaceTree& b, uint32_t samples, const Poller& poller) {
  SurfaceDistance found;
  measure(a, b, samples, poller, found);
  measure(b, a, samples, poller, found);
  return found;
}

double vertex_distance(const SurfaceTree& a, const SurfaceTree& b, const Poller& poller) {
  return std::max(largest_at_vertices(a, b, poller), largest_at_vertices(b, a, poller));
}

}  // namespace papilio
