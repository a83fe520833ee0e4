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

/// Two numbers, each of a vector of its own.
using Two = double __attribute__((vector_size(16)));
struct TwoVectors {
  Two x, y, z;

  friend TwoVectors operator-(const TwoVectors& a, const TwoVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

TwoVectors both(Vec3d one, Vec3d other) { return {Two{one.x, other.x}, Two{one.y, other.y}, Two{one.z, other.z}}; }

/// What face_normal() gives, of a face and the next, to the bit.
void write_two_normals(const Mesh& mesh, uint32_t f, Vec3f* normals) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const auto corners = [&](uint32_t i) {
    return both(to_double(mesh.positions[corner[i]]), to_double(mesh.positions[corner[3 + i]]));
  };
  const TwoVectors a = corners(0);
  const TwoVectors u = corners(1) - a;
  const TwoVectors v = corners(2) - a;
  const TwoVectors n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const Two squared = n.x * n.x + n.y * n.y + n.z * n.z;
  const Two size{std::sqrt(squared[0]), std::sqrt(squared[1])};
  const auto has_area = size > Two{};
  const Two scale = 1 / size;
  const TwoVectors unit{has_area ? scale * n.x : Two{}, has_area ? scale * n.y : Two{}, has_area ? scale * n.z : Two{}};
  for (int i = 0; i < 2; ++i)
    normals[i] = {static_cast<float>(unit.x[i]), static_cast<float>(unit.y[i]), static_cast<float>(unit.z[i])};
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
    uint32_t f = first;
    for (; f + 1 < last; f += 2) write_two_normals(mesh, f, &normals[f]);
    if (f < last) normals[f] = face_normal(mesh, f);
  });
  return normals;
}

Array<Vec3f> normals_of_fours(const Mesh& mesh, const List<uint32_t>& fours, int threads) {
  const auto count = static_cast<uint32_t>(fours.size());
  Array<Vec3f> normals(mesh.topology.face_count());
  for_each_part(parts_of(4 * count, threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; ++i) {
      const uint32_t f = 4 * fours[i];
      write_two_normals(mesh, f, &normals[f]);
      write_two_normals(mesh, f + 2, &normals[f + 2]);
    }
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
