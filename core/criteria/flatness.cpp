#include "criteria/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mesh/curve.h"
#include "mesh/normals.h"
#include "simd/vec3fa.h"

namespace papilio {
namespace {

/// Returns the cosine of the turn from a to b to c; 1 if a piece has no length.
double cosine_of_turn(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3d u = to_double(b) - to_double(a);
  const Vec3d v = to_double(c) - to_double(b);
  const double size = length(u) * length(v);
  return size > 0 ? dot(u, v) / size : 1;
}

bool turns(const Mesh& mesh, const CurveNeighbours& curves, HalfEdgeId h, double threshold) {
  const Vec3f a = mesh.positions[mesh.topology.origin[h]];
  const Vec3f b = mesh.positions[mesh.topology.tip(h)];
  const uint32_t before = curves.before(h);
  if (before != none && cosine_of_turn(mesh.positions[before], a, b) < threshold - product_rounding) return true;
  const uint32_t after = curves.after(h);
  return after != none && cosine_of_turn(a, b, mesh.positions[after]) < threshold - product_rounding;
}

/// Returns the smallest float >= the number: any float is below both or below neither.
float to_float_above(double number) {
  const auto rounded = static_cast<float>(number);
  return rounded < number ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

/// Marks of the sides of a face, 0 or 1.
using MarksOfSides = std::array<uint8_t, 3>;

/// Marks the edges of the region that `marks_of(face, edges [3])` marks for one of their faces; with `grows`, all edges
/// of faces with a marked one. [E]
template <class MarksOf>
Marks mark_by_faces(const Topology& mesh, const Region& region, bool grows, const MarksOf& marks_of) {
  Marks made(mesh.edge_count(), 0);
  uint8_t* const marks = made.data();  // a local pointer is not reloaded for each mark
  const uint32_t* const edges = mesh.edge.data();
  const uint8_t* const has_edge = region.has_edge.data();
  const uint8_t spread = grows ? 1 : 0;
  for (FaceId f : region.faces) {
    const uint32_t* edge = edges + size_t{3} * f;
    const MarksOfSides has{has_edge[edge[0]], has_edge[edge[1]], has_edge[edge[2]]};
    const MarksOfSides own = marks_of(f, edge);
    const uint8_t any = ((own[0] & has[0]) | (own[1] & has[1]) | (own[2] & has[2])) & spread;
    for (uint32_t i = 0; i < 3; ++i) marks[edge[i]] |= (own[i] | any) & has[i];
  }
  return made;
}

void grow_over_vertices(const Topology& mesh, const Region& region, Marks& marks) {
  Buffer<uint8_t> touched(mesh.vertex_count, 0);
  const Buffer<uint32_t> edges = region.edges();
  for (EdgeId e : edges) {
    touched[mesh.origin[mesh.half_edge[e]]] |= marks[e];
    touched[mesh.tip(mesh.half_edge[e])] |= marks[e];
  }
  for (EdgeId e : edges) marks[e] |= touched[mesh.origin[mesh.half_edge[e]]] | touched[mesh.tip(mesh.half_edge[e])];
}

}  // namespace

void grow(const Topology& mesh, Growth growth, const Region& region, Marks& marks) {
  const auto marks_of = [&marks](FaceId /*f*/, const uint32_t* edge) {
    return MarksOfSides{marks[edge[0]], marks[edge[1]], marks[edge[2]]};
  };
  if (growth == Growth::faces) marks = mark_by_faces(mesh, region, true, marks_of);
  if (growth == Growth::vertices) grow_over_vertices(mesh, region, marks);
}

Marks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, double threshold, Growth growth,
                  const Region& region) {
  const Topology& topology = mesh.topology;
  const float least = to_float_above(threshold - product_rounding);
  std::optional<CurveNeighbours> curves;  // computed at the first curve
  const auto is_curved = [&](EdgeId e) -> uint8_t {
    const HalfEdgeId h = topology.half_edge[e];
    if (topology.kind[e] == EdgeKind::cut) return 0;  // no curve: faces beyond its ends are unknown
    if (topology.kind[e] != EdgeKind::smooth) {
      if (!curves) curves.emplace(topology);
      return turns(mesh, *curves, h, threshold) ? 1 : 0;
    }
    const Vec3f n1 = normals[h.face()];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    return has_normal(n1) && has_normal(n2) && dot(n1, n2) < least ? 1 : 0;
  };
  const auto marks_of = [&, twins = topology.twin.data(), kinds = topology.kind.data(), normal = normals.data(), least,
                         last = topology.face_count() - 1](FaceId f, const uint32_t* edge) {
    const uint32_t* twin = twins + size_t{3} * f;
    const auto across = [&](uint32_t i) { return widen(normal[std::min(Topology::face(twin[i]), last)]); };
    const Vec3fa product = dots(widen(normal[f]), across(0), across(1), across(2));
    const float x = product.v[0], y = product.v[1], z = product.v[2];
    const auto kind = [&](uint32_t i) { return static_cast<uint8_t>(kinds[edge[i]]); };
    static_assert(static_cast<uint8_t>(EdgeKind::smooth) == 0);
    if ((kind(0) | kind(1) | kind(2)) != 0 || x * y * z == 0) [[unlikely]]  // on a curve, or maybe without a normal
      return MarksOfSides{is_curved(edge[0]), is_curved(edge[1]), is_curved(edge[2])};
    return MarksOfSides{x < least ? uint8_t{1} : uint8_t{0}, y < least ? uint8_t{1} : uint8_t{0},
                        z < least ? uint8_t{1} : uint8_t{0}};
  };
  Marks marks = mark_by_faces(topology, region, growth == Growth::faces, marks_of);
  if (growth == Growth::vertices) grow_over_vertices(topology, region, marks);
  return marks;
}

}  // namespace papilio
