#include "mesh/normals.h"

#include <array>
#include <cmath>

#include "base/index_range.h"
#include "base/parallel.h"
#include "simd/dispatch.h"
#include "simd/double4.h"
#include "simd/float4.h"

namespace papilio {
namespace {

/// Normal of face f, its length twice the face's area.

/// Some vectors, each with a place in the registers of x, y and z: two or four doubles.
template <class Doubles>
struct Vectors {
  Doubles x, y, z;

  [[gnu::always_inline]] friend Vectors operator-(const Vectors& a, const Vectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] friend Vectors cross(const Vectors& u, const Vectors& v) {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  }
  /// Divided by the length; where that is 0, 0. find_roots(of, roots) has the square roots.
  template <class FindRoots>
  [[gnu::always_inline]] [[nodiscard]] Vectors unit(const FindRoots& find_roots) const {
    Doubles length;
    find_roots(x * x + y * y + z * z, length);
    const auto has_area = length > Doubles{};
    const Doubles scale = 1 / length;
    return {has_area ? scale * x : Doubles{}, has_area ? scale * y : Doubles{}, has_area ? scale * z : Doubles{}};
  }
};

using Two = double __attribute__((vector_size(16)));
void find_two_roots(const Two& of, Two& roots) { roots = Two{std::sqrt(of[0]), std::sqrt(of[1])}; }

/// What face_normal() gives, of a face and the next, to the bit.
void write_two_normals(const Mesh& mesh, uint32_t f, Vec3f* normals) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const auto corners = [&](uint32_t i) {
    const Vec3f& one = mesh.positions[corner[i]];
    const Vec3f& other = mesh.positions[corner[3 + i]];
    return Vectors<Two>{Two{one.x, other.x}, Two{one.y, other.y}, Two{one.z, other.z}};
  };
  const Vectors<Two> a = corners(0);
  const Vectors<Two> n = cross(corners(1) - a, corners(2) - a);
  const Vectors<Two> unit = n.unit(find_two_roots);
  for (int i = 0; i < 2; ++i)
    normals[i] = {static_cast<float>(unit.x[i]), static_cast<float>(unit.y[i]), static_cast<float>(unit.z[i])};
}

void write_four_normals(const Mesh& mesh, uint32_t f, Vec3f* normals) {
  write_two_normals(mesh, f, normals);
  write_two_normals(mesh, f + 2, normals + 2);
}

/// Those of some fours of faces, by number: of faces 4i to 4i + 3.
void write_fours(const Mesh& mesh, const IndexRange& fours, uint32_t first, uint32_t last, Buffer<Vec3f>& normals) {
  for (uint32_t i = first; i < last; ++i) write_four_normals(mesh, 4 * fours[i], &normals[size_t{4} * fours[i]]);
}

#if defined(__x86_64__)
[[PAPILIO_AVX2, gnu::always_inline]] inline Vectors<Double4> in_double(const Vec3x4& p) {
  return {to_double4(p.x), to_double4(p.y), to_double4(p.z)};
}
[[PAPILIO_AVX2, gnu::always_inline]] inline Vec3x4 in_float(const Vectors<Double4>& p) {
  return {to_float4(p.x), to_float4(p.y), to_float4(p.z)};
}

[[PAPILIO_AVX2, gnu::always_inline]] inline void write_four_normals_with_avx2(const Mesh& mesh, uint32_t f,
                                                                              Vec3f* normals) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const Vectors<Double4> a = in_double(at(mesh.positions, {corner[0], corner[3], corner[6], corner[9]}));
  const Vectors<Double4> b = in_double(at(mesh.positions, {corner[1], corner[4], corner[7], corner[10]}));
  const Vectors<Double4> c = in_double(at(mesh.positions, {corner[2], corner[5], corner[8], corner[11]}));
  const std::array<Vec3fa, 4> rows = transposed(in_float(cross(b - a, c - a).unit(find_roots)));
  for (uint32_t i = 0; i < 4; ++i) store(rows[i], normals[i]);
}

/// What write_fours() writes.
[[PAPILIO_AVX2]] void write_fours_with_avx2(const Mesh& mesh, const IndexRange& fours, uint32_t first, uint32_t last,
                                            Buffer<Vec3f>& normals) {
  for (uint32_t i = first; i < last; ++i)
    write_four_normals_with_avx2(mesh, 4 * fours[i], &normals[size_t{4} * fours[i]]);
}
#endif

void write_all(const Mesh& mesh, const IndexRange& fours, int threads, Buffer<Vec3f>& normals) {
  auto* write = &write_fours;
#if defined(__x86_64__)
  if (has_avx2()) write = &write_fours_with_avx2;
#endif
  for_each_part(parts_of(4 * fours.size(), threads), fours.size(),
                [&](uint32_t, uint32_t first, uint32_t last) { write(mesh, fours, first, last, normals); });
}

}  // namespace

Vec3f face_normal(const Mesh& mesh, uint32_t face) {
  const Vec3d n = area_normal(mesh, face);
  const double size = length(n);
  return size > 0 ? to_float((1 / size) * n) : Vec3f{};
}

Buffer<Vec3f> face_normals(const Mesh& mesh, int threads) {
  const uint32_t count = mesh.topology.face_count();
  auto normals = Buffer<Vec3f>::for_overwrite(count);
  write_all(mesh, IndexRange(count / 4), threads, normals);
  for (uint32_t f = count / 4 * 4; f < count; ++f) normals[f] = face_normal(mesh, f);
  return normals;
}

Buffer<Vec3f> normals_of_fours(const Mesh& mesh, const Buffer<uint32_t>& fours, int threads) {
  auto normals = Buffer<Vec3f>::for_overwrite(mesh.topology.face_count());
  write_all(mesh, IndexRange(fours), threads, normals);
  return normals;
}

Vec3d area_normal(const Mesh& mesh, uint32_t f) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const Vec3d a = to_double(mesh.positions[corner[0]]);
  return cross(to_double(mesh.positions[corner[1]]) - a, to_double(mesh.positions[corner[2]]) - a);
}

Buffer<Vec3f> vertex_normals(const Mesh& mesh) {
  Buffer<Vec3d> sums(mesh.topology.vertex_count, Vec3d{});
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
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
