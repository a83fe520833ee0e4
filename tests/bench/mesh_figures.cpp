#include "tests/bench/mesh_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "client/lib/surface_distance.h"

namespace papilio::bench {
namespace {

TriangleCorners corners_of(const TriangleMesh& mesh, const Triangle& t) {
  return {to_double(mesh.positions[t[0]]), to_double(mesh.positions[t[1]]), to_double(mesh.positions[t[2]])};
}

/// Returns the angle between the edges from `apex` to the two others, in radians.
double angle_at(Vec3d apex, Vec3d a, Vec3d b) {
  const Vec3d u = a - apex;
  const Vec3d v = b - apex;
  return std::atan2(length(cross(u, v)), dot(u, v));
}

}  // namespace

SurfaceError surface_error(const TriangleMesh& uniform, const TriangleMesh& result) {
  std::vector<TriangleCorners> triangles;
  triangles.reserve(result.triangles.size());
  for (const Triangle& t : result.triangles) triangles.push_back(corners_of(result, t));
  const client::SurfaceDistance surface(triangles);
  SurfaceError error;
  for (Vec3f p : uniform.positions) {
    const double distance = surface.distance(to_double(p));
    error.rms += distance * distance;
    error.largest = std::max(error.largest, distance);
  }
  error.rms = std::sqrt(error.rms / static_cast<double>(uniform.positions.size()));
  return error;
}

double smallest_angle(const TriangleMesh& mesh) {
  double smallest = std::numbers::pi;
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    if (length(cross(b - a, c - a)) == 0) continue;
    smallest = std::min({smallest, angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
  }
  return smallest * 180 / std::numbers::pi;
}

std::array<double, 7> valence_shares(const TriangleMesh& mesh) {
  std::vector<uint32_t> valences(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (uint32_t v : t) ++valences[v];
  std::array<double, 7> shares{};
  for (uint32_t valence : valences) shares[std::clamp(valence, 3U, 9U) - 3] += 1 / static_cast<double>(valences.size());
  return shares;
}

}  // namespace papilio::bench
