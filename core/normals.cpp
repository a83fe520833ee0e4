#include "normals.h"

#include "parallel.h"

namespace papilio {
namespace {

/// Normal of face f, its length twice the face's area.
Vec3d area_normal(const Mesh& mesh, uint32_t f) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const Vec3d a = to_double(mesh.positions[corner[0]]);
  return cross(to_double(mesh.positions[corner[1]]) - a, to_double(mesh.positions[corner[2]]) - a);
}

}  // namespace

Vec3f face_normal(const Mesh& mesh, uint32_t face) {
  const Vec3d n = area_normal(mesh, face);
  const double size = length(n);
  return size > 0 ? to_float((1 / size) * n) : Vec3f{};
}

Array<Vec3f> face_normals(const Mesh& mesh, int threads) {
  const uint32_t count = mesh.topology.face_count();
  Array<Vec3f> normals(count);
  for_each_part(parts_of(count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t f = first; f < last; ++f) normals[f] = face_normal(mesh, f);
  });
  return normals;
}

Array<Vec3f> normals_of_fours(const Mesh& mesh, const List<uint8_t>& asked_of, int threads) {
  const uint32_t count = mesh.topology.face_count() / 4;
  Array<Vec3f> normals(size_t{4} * count);
  for_each_part(parts_of(count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; ++i)
      for (uint32_t f = 4 * i; f < 4 * i + 4; ++f) normals[f] = asked_of[i] != 0 ? face_normal(mesh, f) : Vec3f{};
  });
  return normals;
}

Array<Vec3f> vertex_normals(const Mesh& mesh) {
  Array<Vec3d> sums(mesh.topology.vertex_count, Vec3d{});
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
    const Vec3d n = area_normal(mesh, f);
    for (uint32_t i = 0; i < 3; ++i) sums[mesh.topology.origin[3 * f + i]] += n;
  }
  Array<Vec3f> normals(sums.size());
  for (size_t v = 0; v < sums.size(); ++v) {
    const double size = length(sums[v]);
    normals[v] = size > 0 ? to_float((1 / size) * sums[v]) : Vec3f{0, 0, 1};
  }
  return normals;
}

}  // namespace papilio
