#include "criteria/lighting.h"

#include <algorithm>
#include <cmath>

#include "criteria/camera.h"
#include "mesh/normals.h"

namespace papilio {
namespace {

constexpr double floor_weight = 0.4;    // lower bound: a surface that bends may turn towards a light
constexpr double least_contrast = 0.3;  // lower bound: the background is unknown, and may be lighter or darker

/// Shading of a face by the sum of all lights, clamped to white.
struct Shade {
  double brightness;  ///< 0..1
  double slope;       ///< derivative of the brightness by the angle of the normal
};

Shade shade(const View& view, Vec3d normal) {
  double sum = 0;
  Vec3d gradient;
  for (const Vec3d& light : view.lights) {
    const Vec3d towards = (1 / length(light)) * light;
    const double cosine = dot(normal, towards);
    if (cosine <= 0) continue;
    sum += cosine;
    gradient += towards - cosine * normal;
  }
  return sum < 1 ? Shade{sum, length(gradient)} : Shade{1, 0};
}

/// Normals of an edge's two faces. A face that is missing or has no normal is replaced by the other.
struct Sides {
  Vec3d normal, other;
  bool is_open;  ///< whether a face is missing
};

Sides sides(const Mesh& mesh, const Buffer<Vec3f>& normals, EdgeId edge) {
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  const HalfEdgeId t = mesh.topology.twin[h];
  const Vec3f normal = normals[h.face()];
  const Vec3f other = t == none ? normal : normals[t.face()];
  return {to_double(has_normal(normal) ? normal : other), to_double(has_normal(other) ? other : normal), t == none};
}

}  // namespace

double light_weight(const Mesh& mesh, const Buffer<Vec3f>& normals, EdgeId edge, double distance, const View& view,
                    const Camera& camera) {
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  const Vec3d a = to_double(mesh.positions[mesh.topology.origin[h]]);
  const Vec3d b = to_double(mesh.positions[mesh.topology.tip(h)]);
  const Vec3d middle = 0.5 * (a + b);
  const Sides faces = sides(mesh, normals, edge);
  // The back of a face is shaded by its reversed normal.
  const auto towards = [&](Vec3d normal) {
    return camera.shows_backs() && camera.is_away(middle, normal) ? -1.0 * normal : normal;
  };
  const Vec3d first = towards(faces.normal);
  const Vec3d second = towards(faces.other);
  const Shade one = shade(view, first);
  const Shade two = shade(view, second);

  const double change = std::abs(one.brightness - two.brightness);
  const double slope = 0.5 * (one.slope + two.slope);
  const double facing =
      0.5 * (std::max(0.0, camera.facing(middle, first)) + std::max(0.0, camera.facing(middle, second)));
  const double shading = 1.3 * (2 * change + slope) * std::sqrt(facing);

  double outline = 0;
  const bool one_is_away = camera.is_away(middle, faces.normal);
  if (faces.is_open || one_is_away != camera.is_away(middle, faces.other)) {
    const double brightness = one_is_away ? two.brightness : one.brightness;
    const double contrast = least_contrast + (1 - least_contrast) * brightness;
    const double pixels = distance * camera.pixels_per_unit(middle);
    outline = 0.8 * contrast * std::sqrt(camera.projected_length(a, b) / std::max(1.0, pixels));
  }
  return length(Vec3d{floor_weight, shading, outline});
}

}  // namespace papilio
