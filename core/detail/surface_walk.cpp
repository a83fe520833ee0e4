#include "detail/surface_walk.h"

#include <array>
#include <cmath>

namespace papilio {
namespace {

constexpr uint32_t most_steps = 1000;
/// Lower bound of the cosine between a face's normal and the line: below it, the face turns away.
constexpr double least_cosine_to_line = 0.1;

}  // namespace

std::optional<LineHit> walk_to_line(const Mesh& surface, uint32_t start_face, Vec3d point, Vec3d direction) {
  const Topology& t = surface.topology;
  uint32_t face = start_face;
  uint32_t from = none;  // half-edge of this face that was crossed last
  for (uint32_t step = 0; step < most_steps; ++step) {
    std::array<Vec3d, 3> corner;
    for (uint32_t i = 0; i < 3; ++i) corner[i] = to_double(surface.positions[t.origin[size_t{3} * face + i]]) - point;
    const Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double along = dot(normal, direction);
    if (!(along > least_cosine_to_line * length(normal))) return std::nullopt;
    // Finds the side that the line is farthest beyond, seen along the line.
    double least = 0;
    uint32_t out = none;
    for (uint32_t i = 0; i < 3; ++i) {
      const Vec3d& a = corner[i];
      const Vec3d& b = corner[(i + 1) % 3];
      const double side = dot(direction, cross(a, b));
      if (side >= 0 || 3 * face + i == from) continue;
      const Vec3d edge = b - a;
      const double flat = dot(edge, direction);
      const double size = std::sqrt(dot(edge, edge) - flat * flat);
      if (side < least * size) least = side / size, out = 3 * face + i;
    }
    if (out == none) return LineHit{face, dot(normal, corner[0]) / along};
    if (t.is_curve(out)) return std::nullopt;
    from = t.twin[out];
    face = Topology::face(from);
  }
  return std::nullopt;
}

}  // namespace papilio
