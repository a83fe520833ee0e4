#include "flatness.h"

#include <limits>
#include <optional>

#include "curve.h"
#include "normals.h"

namespace papilio {
namespace {

constexpr float unknown = std::numeric_limits<float>::infinity();
constexpr float flat = 2;

/// Cosine of the turn from a to b to c; 1 where a piece has no length.
double cosine_of_turn(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3d u = to_double(b) - to_double(a);
  const Vec3d v = to_double(c) - to_double(b);
  const double size = length(u) * length(v);
  return size > 0 ? dot(u, v) / size : 1;
}

bool turns(const Mesh& mesh, const CurveNeighbours& curves, uint32_t h, double threshold) {
  const Vec3f a = mesh.positions[mesh.topology.origin[h]];
  const Vec3f b = mesh.positions[mesh.topology.tip(h)];
  const uint32_t before = curves.before(h);
  if (before != none && cosine_of_turn(mesh.positions[before], a, b) < threshold - product_rounding) return true;
  const uint32_t after = curves.after(h);
  return after != none && cosine_of_turn(a, b, mesh.positions[after]) < threshold - product_rounding;
}

}  // namespace

List<uint32_t> find_curved(const Mesh& mesh, const Array<Vec3f>& normals, const NormalProducts& products,
                           double threshold, const Region& region) {
  const Topology& topology = mesh.topology;
  std::optional<CurveNeighbours> curves;  // made when the first curve is met: there may be none
  const double least = threshold - product_rounding;
  const auto product_at = [&](uint32_t h, uint32_t t) {
    const Vec3f n1 = normals[Topology::face(h)];
    const Vec3f n2 = normals[Topology::face(t)];
    const float product = dot(n1, n2);
    return product != 0 || (has_normal(n1) && has_normal(n2)) ? product : flat;  // without a normal it is 0
  };
  const auto is_curved = [&](uint32_t e) {
    const uint32_t h = topology.half_edge[e];
    if (topology.kind[e] != EdgeKind::smooth) {
      if (topology.kind[e] == EdgeKind::cut) return false;  // no curve: what lies beyond its ends is not known
      if (!curves) curves.emplace(topology);
      return turns(mesh, *curves, h, threshold);
    }
    const float product = product_at(h, topology.twin[h]);
    if (!products.empty()) products.put(e, product);
    return product < least;
  };
  List<uint32_t> found = region.edges;
  keep_if(found, [&](uint32_t e) {
    const float known = products.empty() ? unknown : products.get(e);
    return known != unknown ? known < least : is_curved(e);
  });
  return found;
}

void mark_by_flatness(const Mesh& mesh, const Array<Vec3f>& normals, double threshold, EdgeMarks& marks) {
  for (uint32_t e : find_curved(mesh, normals, {}, threshold, whole_region(mesh.topology))) marks[e] = 1;
}

namespace {

void grow_over_faces(const Topology& mesh, const List<uint32_t>& seeds, const Region& region, EdgeMarks& marks) {
  const auto mark_others = [&](uint32_t h) {
    marks[mesh.edge[Topology::next(h)]] = 1;
    marks[mesh.edge[Topology::previous(h)]] = 1;
  };
  EdgeMarks shared;  // of the seeds: one edge does not name all of its faces
  for (uint32_t e : seeds) {
    if (mesh.kind[e] == EdgeKind::shared) {
      if (shared.empty()) shared.assign(mesh.edge_count(), 0);
      shared[e] = 1;
      continue;
    }
    const uint32_t h = mesh.half_edge[e];
    mark_others(h);
    if (const uint32_t t = mesh.twin[h]; t != none) mark_others(t);
  }
  if (shared.empty()) return;
  for (uint32_t f : region.faces)
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      if (shared[mesh.edge[h]] != 0) mark_others(h);
}

void grow_over_vertices(const Topology& mesh, const List<uint32_t>& seeds, const Region& region, EdgeMarks& marks) {
  List<uint8_t> touched(mesh.vertex_count, 0);
  for (uint32_t e : seeds) {
    touched[mesh.origin[mesh.half_edge[e]]] = 1;
    touched[mesh.tip(mesh.half_edge[e])] = 1;
  }
  for (uint32_t e : region.edges)
    if (touched[mesh.origin[mesh.half_edge[e]]] != 0 || touched[mesh.tip(mesh.half_edge[e])] != 0) marks[e] = 1;
}

}  // namespace

void grow(const Topology& mesh, Growth growth, const List<uint32_t>& seeds, const Region& region, EdgeMarks& marks) {
  for (uint32_t e : seeds) marks[e] = 1;
  if (growth == Growth::faces) grow_over_faces(mesh, seeds, region, marks);
  if (growth == Growth::vertices) grow_over_vertices(mesh, seeds, region, marks);
}

void grow(const Topology& mesh, Growth growth, EdgeMarks& marks) {
  grow(mesh, growth, marked(marks), whole_region(mesh), marks);
}

}  // namespace papilio
