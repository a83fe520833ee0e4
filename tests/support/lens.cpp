#include "tests/support/lens.h"

#include <cmath>
#include <numbers>

namespace papilio::test {
namespace {

/// Angle from the axis to the rim, seen from the centre of a cap.
double cap_angle(double degrees) { return (180 - degrees) / 2 * std::numbers::pi / 180; }

Vec3f place_on_cap(double along, double round, double degrees) {
  const double cap = cap_angle(degrees);
  const double angle = along * cap;
  const double size = std::sin(angle);
  return to_float({size * std::cos(round), size * std::sin(round), std::cos(angle) - std::cos(cap)});
}

Vec3d mirrored(Vec3d p, bool is_upper) { return {p.x, p.y, is_upper ? p.z : -p.z}; }

/// Adds a cap: its tip, then its rings, the rim as the last one.
void add_cap(TriangleMesh& mesh, uint32_t n, uint32_t m, double degrees, bool is_upper) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  const auto add = [&](double along, double round) {
    mesh.positions.push_back(to_float(mirrored(to_double(place_on_cap(along, round, degrees)), is_upper)));
  };
  add(0, 0);
  for (uint32_t ring = 1; ring <= m; ++ring)
    for (uint32_t i = 0; i < n; ++i) add(double{1} * ring / m, 2 * std::numbers::pi * i / n);
  const auto at = [&](uint32_t ring, uint32_t i) { return ring == 0 ? first : first + 1 + (ring - 1) * n + i % n; };
  const auto add_triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    mesh.triangles.push_back(is_upper ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  for (uint32_t ring = 0; ring < m; ++ring)
    for (uint32_t i = 0; i < n; ++i) {
      add_triangle(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      if (ring > 0) add_triangle(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
}

/// Gives each face separate points.
void part_faces(TriangleMesh& mesh) {
  TriangleMesh parted;
  for (Triangle& triangle : mesh.triangles)
    for (uint32_t& corner : triangle) {
      parted.positions.push_back(mesh.positions[corner]);
      corner = static_cast<uint32_t>(parted.positions.size() - 1);
    }
  mesh.positions = parted.positions;
}

}  // namespace

Vec3d lens_normal(Vec3f point, double degrees, bool is_upper) {
  Vec3d of_upper = mirrored(to_double(point), is_upper);
  of_upper.z += std::cos(cap_angle(degrees));
  return mirrored((1 / length(of_upper)) * of_upper, is_upper);
}

TriangleMesh lens(uint32_t n, uint32_t m, double degrees, Shading shading) {
  TriangleMesh mesh;
  add_cap(mesh, n, m, degrees, true);
  const size_t upper = mesh.positions.size();
  add_cap(mesh, n, m, degrees, false);
  if (shading == Shading::absent) return mesh;
  Attribute normals{.components = 3, .unit_length = true, .values = {}};
  const auto add_normal = [&](Vec3d normal) {
    normals.values.insert(normals.values.end(), {normal.x, normal.y, normal.z});
  };
  if (shading == Shading::faceted) {
    part_faces(mesh);
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
      const auto corner = [&](size_t i) { return to_double(mesh.positions[3 * f + i]); };
      const Vec3d normal = cross(corner(1) - corner(0), corner(2) - corner(0));
      for (int i = 0; i < 3; ++i) add_normal((1 / length(normal)) * normal);
    }
  } else {
    for (size_t p = 0; p < mesh.positions.size(); ++p) {
      Vec3d normal = lens_normal(mesh.positions[p], degrees, p < upper);
      if (shading == Shading::smooth && mesh.positions[p].z == 0) normal.z = 0;
      add_normal((1 / length(normal)) * normal);
    }
  }
  mesh.attributes.push_back(std::move(normals));
  return mesh;
}

}  // namespace papilio::test
