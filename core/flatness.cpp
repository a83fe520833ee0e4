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

void mark_by_flatness(const Mesh& mesh, const Array<Vec3f>& normals, const NormalProducts& products, double threshold,
                      const Region& region, EdgeMarks& marks) {
  const Topology& topology = mesh.topology;
  std::optional<CurveNeighbours> curves;  // made when the first curve is met: there may be none
  const double least = threshold - product_rounding;
  for (uint32_t e : region.edges) {
    const float known = products.empty() ? unknown : products.get(e);
    if (known != unknown) {
      if (known < least) marks[e] = 1;
      continue;
    }
    const uint32_t h = topology.half_edge[e];
    const uint32_t t = topology.twin[h];
    if (topology.kind[e] == EdgeKind::cut) continue;  // no curve: what lies beyond its ends is not known
    if (topology.kind[e] != EdgeKind::smooth) {
      if (!curves) curves.emplace(topology);
      if (turns(mesh, *curves, h, threshold)) marks[e] = 1;
      continue;
    }
    const Vec3f n1 = normals[Topology::face(h)];
    const Vec3f n2 = normals[Topology::face(t)];
    const float product = has_normal(n1) && has_normal(n2) ? dot(n1, n2) : flat;
    if (!products.empty()) products.put(e, product);
    if (product < least) marks[e] = 1;
  }
}

void mark_by_flatness(const Mesh& mesh, const Array<Vec3f>& normals, double threshold, EdgeMarks& marks) {
  mark_by_flatness(mesh, normals, {}, threshold, whole_region(mesh.topology), marks);
}

void grow(const Topology& mesh, Growth growth, const Region& region, EdgeMarks& marks) {
  if (growth == Growth::off) return;
  const EdgeMarks seeds = marks;
  if (growth == Growth::faces) {
    for (uint32_t f : region.faces)
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        if (seeds[mesh.edge[h]] == 0) continue;
        marks[mesh.edge[Topology::next(h)]] = 1;
        marks[mesh.edge[Topology::previous(h)]] = 1;
      }
    return;
  }
  List<uint8_t> touched(mesh.vertex_count, 0);
  for (uint32_t e : region.edges) {
    if (seeds[e] == 0) continue;
    touched[mesh.origin[mesh.half_edge[e]]] = 1;
    touched[mesh.tip(mesh.half_edge[e])] = 1;
  }
  for (uint32_t e : region.edges)
    if (touched[mesh.origin[mesh.half_edge[e]]] != 0 || touched[mesh.tip(mesh.half_edge[e])] != 0) marks[e] = 1;
}

void grow(const Topology& mesh, Growth growth, EdgeMarks& marks) { grow(mesh, growth, whole_region(mesh), marks); }

}  // namespace papilio
