#include "criteria/deviation_range.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/index_range.h"
#include "base/parallel.h"
#include "simd/float4.h"

namespace papilio {
namespace {

[[nodiscard]] Float4 rooms_of_four(const Mesh& mesh, const Index4& faces) {
  constexpr float least_sine = 1e-4F;  // of narrower ones too little is certain
  constexpr float rounding = 0.99F;
  const auto corners = [&](uint32_t i) {
    const auto& origin = mesh.topology.origin;
    return at(mesh.positions,
              {origin[3 * faces[0] + i], origin[3 * faces[1] + i], origin[3 * faces[2] + i], origin[3 * faces[3] + i]});
  };
  const Vec3x4 a = corners(0);
  const Vec3x4 ab = corners(1) - a;
  const Vec3x4 ac = corners(2) - a;
  const Vec3x4 bc = ac - ab;
  const Vec3x4 normal = cross(ab, ac);
  const Float4 area_squared = dot(normal, normal);  // of the parallelogram
  const Float4 longest_squared = larger(dot(ab, ab), larger(dot(ac, ac), dot(bc, bc)));
  const auto is_wide =
      is_usual(longest_squared) & (area_squared > least_sine * least_sine * longest_squared * longest_squared);
  // A side's middle is half as far from another side as the corner where it ends.
  const Float4 squared = is_wide ? area_squared / longest_squared : Float4{};
  return 0.5F * rounding * root(squared);
}

/// Where what an edge's range is made of lies in its arrays.
struct Place {
  Place(const Topology& mesh, uint32_t edge) {
    const uint32_t h = mesh.half_edge[edge];
    a = mesh.origin[h];
    b = mesh.tip(h);
    face = Topology::face(h);
    is_smooth = mesh.kind[edge] == EdgeKind::smooth;
    twin_face = is_smooth ? Topology::face(mesh.twin[h]) : face;
  }
  uint32_t a, b, face, twin_face;
  bool is_smooth;
};

}  // namespace

Buffer<float> rooms_at_sides(const Mesh& mesh, const Buffer<uint32_t>* fours, int threads) {
  const uint32_t count = mesh.topology.face_count();
  const IndexRange of((count + 3) / 4, fours);
  auto rooms = Buffer<float>::for_overwrite(count);
  for_each_part(parts_of(4 * of.size(), threads), of.size(), [&](uint32_t, uint32_t first, uint32_t last) {
    for (uint32_t i = first; i < last; ++i) {
      const uint32_t most = count - 1;
      const uint32_t f = 4 * of[i];
      const Float4 four = rooms_of_four(mesh, {f, std::min(f + 1, most), std::min(f + 2, most), std::min(f + 3, most)});
      for (uint32_t k = 0; k < 4 && f + k < count; ++k) rooms[f + k] = four[k];
    }
  });
  return rooms;
}

std::array<DeviationRange, 4> DeviationBounds::find(const std::array<uint32_t, 4>& edges) const {
  constexpr float rounding = 2e-6F;  // more than that of normals and of what is computed here, as a share of the edge
  const Topology& topology = mesh.topology;
  const std::array<Place, 4> place{Place(topology, edges[0]), Place(topology, edges[1]), Place(topology, edges[2]),
                                   Place(topology, edges[3])};
  const auto points = [&place](const Buffer<Vec3f>& from, uint32_t Place::*which) {
    return at(from, {place[0].*which, place[1].*which, place[2].*which, place[3].*which});
  };
  // The room on both sides; none on a curve, where the deviation is another.
  const auto room = [&](size_t i) {
    return place[i].is_smooth ? std::min(rooms[place[i].face], rooms[place[i].twin_face]) : 0;
  };
  const Vec3x4 a = points(mesh.positions, &Place::a);
  const Vec3x4 along = points(mesh.positions, &Place::b) - a;
  const Vec3x4 off = at(made, edges) - a - 0.5F * along;
  const Float4 along_squared = dot(along, along);
  const Float4 off_squared = dot(off, off);
  const Float4 room_of_each{room(0), room(1), room(2), room(3)};
  const auto are_usual = is_usual(along_squared);
  const auto has_room = are_usual & (off_squared < room_of_each * room_of_each);

  // The foot of the vertex on a face's plane is in the face, or beyond the edge and no other side; then the edge is
  // nearest.
  const Vec3x4 inward = cross(along, off);
  const Float4 to_edge = dot(inward, inward) / along_squared;
  const Vec3x4 normal = points(normals, &Place::face);
  const Vec3x4 twin_normal = points(normals, &Place::twin_face);
  const Float4 height = dot(off, normal);
  const Float4 twin_height = dot(off, twin_normal);
  const Float4 to_face = dot(inward, normal) >= Float4{} ? height * height : to_edge;
  const Float4 to_twin_face = dot(inward, twin_normal) <= Float4{} ? twin_height * twin_height : to_edge;

  constexpr float smallest = std::numeric_limits<float>::min();
  const Float4 distance = root(has_room ? lesser(to_face, to_twin_face) : off_squared);
  const Float4 most_off = sum_of_magnitudes(off);
  const Float4 unsure = rounding * (sum_of_magnitudes(along) + most_off) + smallest;
  const Float4 least = has_room ? larger(distance - unsure, Float4{}) : Float4{};
  const Float4 most = (are_usual ? distance : most_off) + unsure;
  return {{{least[0], most[0]}, {least[1], most[1]}, {least[2], most[2]}, {least[3], most[3]}}};
}

}  // namespace papilio
