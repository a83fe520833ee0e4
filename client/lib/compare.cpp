#include "client/lib/compare.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/lib/surface_distance.h"

namespace papilio::client {
namespace {

using Triangles = std::vector<TriangleCorners>;

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Returns the corners of all triangles. `name` is the mesh's name for messages.
Triangles corners_of(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.triangles.empty()) throw std::invalid_argument(name + " has no triangles: there is nothing to compare");
  const auto corner = [&](uint32_t vertex) {
    if (vertex >= mesh.positions.size())
      throw std::invalid_argument(name + " names vertex " + std::to_string(vertex) + ", which it does not have");
    const Vec3d position = to_double(mesh.positions[vertex]);
    if (!is_finite(position))
      throw std::invalid_argument(name + " has a coordinate that is not finite, at vertex " + std::to_string(vertex));
    return position;
  };
  Triangles triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) triangles.push_back({corner(a), corner(b), corner(c)});
  return triangles;
}

std::vector<Vec3d> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles)
    for (const uint32_t vertex : triangle) used[vertex] = true;
  std::vector<Vec3d> vertices;
  for (size_t i = 0; i < used.size(); ++i)
    if (used[i]) vertices.push_back(to_double(mesh.positions[i]));
  return vertices;
}

struct Sample {
  Vec3d position;
  Vec3d normal;  ///< unit normal
};

double area(const TriangleCorners& triangle) {
  return 0.5 * length(cross(triangle.b - triangle.a, triangle.c - triangle.a));
}

/// Returns the fractional part of a multiple: a deterministic sequence, evenly spread over 0..1.
double spread(size_t index, double step) { return std::fmod(0.5 + static_cast<double>(index) * step, 1.0); }

Vec3d point_in(const TriangleCorners& triangle, size_t index) {
  // Martin Roberts' R2 sequence (2018): steps 1/g and 1/g^2 with g^3 = g + 1. The square is folded onto the
  // triangle.
  constexpr double kStep = 0.7548776662466927;
  double u = spread(index, kStep);
  double v = spread(index, kStep * kStep);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return triangle.a + u * (triangle.b - triangle.a) + v * (triangle.c - triangle.a);
}

/// Returns `count` points for equal shares of the area; none if there is no area.
std::vector<Sample> sample_by_area(std::span<const TriangleCorners> triangles, size_t count) {
  double total = 0;
  for (const TriangleCorners& triangle : triangles) total += area(triangle);
  std::vector<Sample> samples;
  if (!(total > 0)) return samples;
  samples.reserve(count);
  double passed = 0;
  for (const TriangleCorners& triangle : triangles) {
    passed += area(triangle);
    const auto normal = unit_normal(triangle);
    const auto due = [&] { return (static_cast<double>(samples.size()) + 0.5) / static_cast<double>(count) * total; };
    while (normal && samples.size() < count && due() < passed)
      samples.push_back({point_in(triangle, samples.size()), *normal});
  }
  return samples;
}

struct OneWay {
  double max = 0;
  double rms = 0;
  double degrees_sum = 0;
  size_t degrees_count = 0;
};

double degrees(double cosine) { return std::acos(cosine) * 180 / std::numbers::pi; }

OneWay measure(std::span<const Vec3d> vertices, std::span<const Sample> samples, const SurfaceDistance& surface) {
  OneWay result;
  double vertex_squares = 0;
  for (const Vec3d vertex : vertices) {
    const double distance = surface.distance(vertex);
    result.max = std::max(result.max, distance);
    vertex_squares += distance * distance;
  }
  double sample_squares = 0;
  for (const Sample& sample : samples) {
    const auto [distance, cosine] = surface.nearest(sample.position, sample.normal);
    result.max = std::max(result.max, distance);
    sample_squares += distance * distance;
    if (!cosine) continue;
    result.degrees_sum += degrees(*cosine);
    ++result.degrees_count;
  }
  result.rms = samples.empty() ? std::sqrt(vertex_squares / static_cast<double>(vertices.size()))
                               : std::sqrt(sample_squares / static_cast<double>(samples.size()));
  return result;
}

double diagonal_of(std::span<const Vec3d> vertices) {
  Vec3d low = vertices[0], high = vertices[0];
  for (const Vec3d p : vertices) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low);
}

}  // namespace

Comparison compare(const TriangleMesh& a, const TriangleMesh& b, const CompareOptions& options,
                   const std::array<std::string, 2>& names) {
  const Triangles a_triangles = corners_of(a, names[0]);
  const Triangles b_triangles = corners_of(b, names[1]);
  const std::vector<Vec3d> a_vertices = used_vertices(a);
  const std::vector<Vec3d> b_vertices = used_vertices(b);
  const OneWay forward =
      measure(a_vertices, sample_by_area(a_triangles, options.samples), SurfaceDistance(b_triangles));
  const OneWay backward =
      measure(b_vertices, sample_by_area(b_triangles, options.samples), SurfaceDistance(a_triangles));

  const size_t angles = forward.degrees_count + backward.degrees_count;
  return {
      .hausdorff = std::max(forward.max, backward.max),
      .rms = std::max(forward.rms, backward.rms),
      .max_forward = forward.max,
      .max_backward = backward.max,
      .rms_forward = forward.rms,
      .rms_backward = backward.rms,
      .diagonal = diagonal_of(a_vertices),
      .normal_degrees_mean =
          angles == 0 ? 0 : (forward.degrees_sum + backward.degrees_sum) / static_cast<double>(angles),
  };
}

}  // namespace papilio::client
