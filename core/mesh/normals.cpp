#include "mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace papilio {
namespace {

using Two = double __attribute__((vector_size(16)));

/// Computes the unit normals of two faces, so that their roots and divisions overlap; zero without area. The lanes are
/// filled from single floats: vectors that a compiler reads back from stored doubles stall.
void put_unit_normals(const Mesh& mesh, FaceId f, FaceId g, Vec3f& unit_f, Vec3f& unit_g) {
  const auto corner = [&](uint32_t i) {
    const Vec3f& p = mesh.positions[mesh.topology.origin[size_t{3} * f + i]];
    const Vec3f& q = mesh.positions[mesh.topology.origin[size_t{3} * g + i]];
    return std::array<Two, 3>{Two{p.x, q.x}, Two{p.y, q.y}, Two{p.z, q.z}};
  };
  const auto [ax, ay, az] = corner(0);
  const auto [bx, by, bz] = corner(1);
  const auto [cx, cy, cz] = corner(2);
  const Two ux = bx - ax;
  const Two uy = by - ay;
  const Two uz = bz - az;
  const Two vx = cx - ax;
  const Two vy = cy - ay;
  const Two vz = cz - az;
  const Two x = uy * vz - uz * vy;
  const Two y = uz * vx - ux * vz;
  const Two z = ux * vy - uy * vx;
  const Two squared = x * x + y * y + z * z;
  const Two length{std::sqrt(squared[0]), std::sqrt(squared[1])};
  const Two scale = 1 / length;
  const auto has_area = length > Two{};
  const Two unit_x = has_area ? scale * x : Two{};
  const Two unit_y = has_area ? scale * y : Two{};
  const Two unit_z = has_area ? scale * z : Two{};
  unit_f = to_float({unit_x[0], unit_y[0], unit_z[0]});
  unit_g = to_float({unit_x[1], unit_y[1], unit_z[1]});
}

}  // namespace

Buffer<Vec3f> face_normals(const Mesh& mesh, int threads) {
  const uint32_t count = mesh.topology.face_count();
  auto normals = Buffer<Vec3f>::for_overwrite(count);
  for_each_part(parts_of(count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t f = first; f < last; f += 2) {
      const uint32_t g = std::min(f + 1, last - 1);
      put_unit_normals(mesh, f, g, normals[f], normals[g]);
    }
  });
  return normals;
}

Buffer<Vec3f> vertex_normals(const Mesh& mesh) {
  Buffer<Vec3d> sums(mesh.topology.vertex_count, Vec3d{});
  for (FaceId f = 0; f < mesh.topology.face_count(); ++f) {
    const Vec3d n = area_normal(mesh, f);
    for (uint32_t i = 0; i < 3; ++i) sums[mesh.topology.origin[3 * f + i]] += n;
  }
  auto normals = Buffer<Vec3f>::for_overwrite(sums.size());
  for (size_t v = 0; v < sums.size(); ++v) {
    const double size = length(sums[v]);
    normals[v] = size > 0 ? to_float((1 / size) * sums[v]) : Vec3f{0, 0, 1};
  }
  return normals;
}

}  // namespace papilio
