#include "tests/gallery/harm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "client/lib/surface_distance.h"
#include "core/mesh/hinge.h"

namespace papilio::test {
namespace {

constexpr double fold_cosine = -0.5;  // cosine of 120 degrees

double overshoot(const Box& coarse, const Box& fine) {
  const std::array<float, 6> out{coarse.min.x - fine.min.x, coarse.min.y - fine.min.y, coarse.min.z - fine.min.z,
                                 fine.max.x - coarse.max.x, fine.max.y - coarse.max.y, fine.max.z - coarse.max.z};
  return static_cast<double>(*std::ranges::max_element(out)) / coarse.diagonal();
}

}  // namespace

uint32_t count_folds(const Mesh& mesh) {
  uint32_t folds = 0;
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    if (mesh.topology.twin[h] == none) continue;
    folds += Hinge(mesh.topology, mesh.positions, h).cosine() < fold_cosine ? 1 : 0;
  }
  return folds;
}

Harm harm_of(const Mesh& coarse, const Mesh& fine, int levels) {
  const uint32_t there = count_folds(coarse) << levels;
  const uint32_t folds = count_folds(fine);
  return {.folds = folds > there ? folds - there : 0,
          .overshoot = std::max(0.0, overshoot(bounding_box(coarse.positions), bounding_box(fine.positions))),
          .distance = rms_distance(fine, coarse)};
}

double rms_distance(const Mesh& from, const Mesh& to) {
  std::vector<TriangleCorners> triangles;
  const auto corners = [](const Mesh& mesh, uint32_t f) {
    const auto at = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
    return TriangleCorners{at(0), at(1), at(2)};
  };
  for (uint32_t f = 0; f < to.topology.face_count(); ++f) triangles.push_back(corners(to, f));
  const client::SurfaceDistance surface(triangles);
  double squares = 0;
  double areas = 0;
  for (uint32_t f = 0; f < from.topology.face_count(); ++f) {
    const auto [a, b, c] = corners(from, f);
    const double area = length(cross(b - a, c - a));
    const double distance = surface.distance(1.0 / 3 * (a + b + c));
    squares += area * distance * distance;
    areas += area;
  }
  return areas > 0 ? std::sqrt(squares / areas) / bounding_box(to.positions).diagonal() : 0;
}

}  // namespace papilio::test
