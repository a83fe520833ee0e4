#include "mesh/normals.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace papilio {
namespace {

using Two = double __attribute__((vector_size(16)));

/// Normalizes two vectors, so that their roots and divisions overlap; a zero vector stays zero.
void put_unit(Vec3d a, Vec3d b, Vec3f& unit_a, Vec3f& unit_b) {
  const Two x{a.x, b.x};
  const Two y{a.y, b.y};
  const Two z{a.z, b.z};
  const Two squared = x * x + y * y + z * z;
  const Two length{std::sqrt(squared[0]), std::sqrt(squared[1])};
  const Two scale = 1 / length;
  const auto has_area = length > Two{};
  const Two unit_x = has_area ? scale * x : Two{};
  const Two unit_y = has_area ? scale * y : Two{};
  const Two unit_z = has_area ? scale * z : Two{};
  unit_a = to_float({unit_x[0], unit_y[0], unit_z[0]});
  unit_b = to_float({unit_x[1], unit_y[1], unit_z[1]});
}

}  // namespace

Buffer<Vec3f> face_normals(const Mesh& mesh, int threads) {
  const uint32_t count = mesh.topology.face_count();
  auto normals = Buffer<Vec3f>::for_overwrite(count);
  for_each_part(parts_of(count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t f = first; f < last; f += 2) {
      const uint32_t g = std::min(f + 1, last - 1);
      put_unit(area_normal(mesh, f), area_normal(mesh, g), normals[f], normals[g]);
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
