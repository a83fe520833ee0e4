#include "criteria/flatness.h"

#include <optional>

#include "mesh/curve.h"
#include "mesh/normals.h"

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

void grow_over_faces(const Topology& mesh, const Region& region, Marks& marks) {
  const Marks own = marks;
  for (FaceId f : region.faces) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    const uint8_t any = own[edge[0]] | own[edge[1]] | own[edge[2]];
    for (uint32_t i = 0; i < 3; ++i) marks[edge[i]] |= any & region.has_edge[edge[i]];
  }
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
  if (growth == Growth::faces) grow_over_faces(mesh, region, marks);
  if (growth == Growth::vertices) grow_over_vertices(mesh, region, marks);
}

Marks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, double threshold, Growth growth,
                  const Region& region) {
  const Topology& topology = mesh.topology;
  std::optional<CurveNeighbours> curves;  // computed at the first curve
  const auto is_curved = [&](EdgeId e) {
    const HalfEdgeId h = topology.half_edge[e];
    if (topology.kind[e] == EdgeKind::cut) return false;  // no curve: faces beyond its ends are unknown
    if (topology.kind[e] != EdgeKind::smooth) {
      if (!curves) curves.emplace(topology);
      return turns(mesh, *curves, h, threshold);
    }
    const Vec3f n1 = normals[h.face()];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    return has_normal(n1) && has_normal(n2) && dot(n1, n2) < threshold - product_rounding;
  };
  Marks marks(topology.edge_count(), 0);
  for (EdgeId e : region.edges()) marks[e] = is_curved(e) ? 1 : 0;
  grow(topology, growth, region, marks);
  return marks;
}

}  // namespace papilio
