#include "tests/support/two_sided_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/lib/surface_distance.h"

namespace papilio::test {
using client::SurfaceDistance;

std::vector<TriangleCorners> corners_of(const Mesh& mesh) {
  std::vector<TriangleCorners> all;
  all.reserve(mesh.topology.face_count());
  const auto at = [&](uint32_t h) { return to_double(mesh.positions[mesh.topology.origin[h]]); };
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); h += 3) all.push_back({at(h), at(h + 1), at(h + 2)});
  return all;
}

std::array<Vec3d, 15> samples_of(const TriangleCorners& face) {
  constexpr int steps = 4;
  std::array<Vec3d, 15> samples;
  size_t at = 0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps;
      const double v = static_cast<double>(j) / steps;
      samples[at++] = (1 - u - v) * face.a + u * face.b + v * face.c;
    }
  return samples;
}

TwoSidedDistance two_sided_distance(const Mesh& adaptive, const Mesh& uniform) {
  const std::vector<TriangleCorners> faces = corners_of(adaptive);
  const SurfaceDistance to_adaptive(faces);
  const SurfaceDistance to_uniform(corners_of(uniform));
  TwoSidedDistance found;
  double sum = 0;
  for (const Vec3f& p : uniform.positions) {
    const double distance = to_adaptive.distance(to_double(p));
    found.to_adaptive = std::max(found.to_adaptive, distance);
    sum += distance * distance;
  }
  found.rms = std::sqrt(sum / static_cast<double>(uniform.positions.size()));
  for (const TriangleCorners& face : faces)
    for (const Vec3d& sample : samples_of(face))
      found.to_uniform = std::max(found.to_uniform, to_uniform.distance(sample));
  return found;
}

}  // namespace papilio::test
