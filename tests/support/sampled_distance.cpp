#include "tests/support/sampled_distance.h"

#include <algorithm>
#include <cmath>

namespace papilio::test {
namespace {

std::vector<TriangleCorners> corners_of(const TriangleMesh& mesh) {
  std::vector<TriangleCorners> all;
  all.reserve(mesh.triangles.size());
  const auto at = [&](uint32_t v) { return to_double(mesh.positions[v]); };
  for (const auto& [a, b, c] : mesh.triangles) all.push_back({at(a), at(b), at(c)});
  return all;
}

double area(const TriangleCorners& t) { return 0.5 * length(cross(t.b - t.a, t.c - t.a)); }

double fraction(double value) { return value - std::floor(value); }

/// Returns point `index` of a low-discrepancy sequence in the triangle.
Vec3d point_in(const TriangleCorners& t, size_t index) {
  constexpr double step = 0.7548776662466927;  // 1/g with g^3 = g + 1
  double u = fraction(0.5 + static_cast<double>(index) * step);
  double v = fraction(0.5 + static_cast<double>(index) * step * step);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return t.a + u * (t.b - t.a) + v * (t.c - t.a);
}

SampledDistance distance(std::span<const Vec3d> points, const client::SurfaceDistance& surface) {
  SampledDistance found;
  for (const Vec3d p : points) {
    const double distance = surface.distance(p);
    found.rms += distance * distance;
    found.largest = std::max(found.largest, distance);
  }
  found.rms = std::sqrt(found.rms / static_cast<double>(std::max<size_t>(points.size(), 1)));
  return found;
}

}  // namespace

std::vector<Vec3d> sample_by_area(std::span<const TriangleCorners> triangles, size_t count) {
  double total = 0;
  for (const TriangleCorners& t : triangles) total += area(t);
  std::vector<Vec3d> samples;
  double until = 0;
  for (const TriangleCorners& t : triangles) {
    until += area(t);
    while (samples.size() < count &&
           (static_cast<double>(samples.size()) + 0.5) * total < until * static_cast<double>(count))
      samples.push_back(point_in(t, samples.size()));
  }
  return samples;
}

SampledSurface::SampledSurface(const TriangleMesh& original, size_t samples)
    : triangles_(corners_of(original)),
      tree_(triangles_),
      samples_(sample_by_area(triangles_, samples)),
      diagonal_(bounding_box(original.positions).diagonal()) {}

SampledDistance SampledSurface::distance_to(const TriangleMesh& other) const {
  const std::vector<TriangleCorners> triangles = corners_of(other);
  const SampledDistance there = distance(samples_, client::SurfaceDistance(triangles));
  const SampledDistance back = distance(sample_by_area(triangles, samples_.size()), tree_);
  const double percent = 100 / diagonal_;
  return {percent * std::max(there.rms, back.rms), percent * std::max(there.largest, back.largest)};
}

}  // namespace papilio::test
