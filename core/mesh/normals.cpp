#include "mesh/normals.h"

#include "base/parallel.h"

namespace papilio {
Buffer<Vec3f> face_normals(const Mesh& mesh, int threads) {
  const uint32_t count = mesh.topology.face_count();
  auto normals = Buffer<Vec3f>::for_overwrite(count);
  for_each_part(parts_of(count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (FaceId f = first; f < last; ++f) {
      const Vec3d n = area_normal(mesh, f);
      const double size = length(n);
      normals[f] = size > 0 ? to_float((1 / size) * n) : Vec3f{};
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
