#include "criteria/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mesh/curve.h"
#include "mesh/four_children.h"
#include "mesh/normals.h"
#include "simd/float4.h"

namespace papilio {
namespace {

constexpr float unknown = std::numeric_limits<float>::infinity();
constexpr float flat = 2;

/// The least float that is.
float no_less_than(double number) {
  const auto rounded = static_cast<float>(number);
  return rounded < number ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

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

/// Between four faces and four others, by their normals.
[[nodiscard, gnu::always_inline]] inline Mask4 are_curved(const Vec3x4& one, const Vec3x4& other, float least) {
  const auto has_normal = [](const Vec3x4& n) { return (n.x != 0) | (n.y != 0) | (n.z != 0); };
  return (dot(one, other) < least) & has_normal(one) & has_normal(other);
}

/// Which of a region's edges are not flat.
class CurvedFinder {
 public:
  CurvedFinder(const Mesh& mesh, const Buffer<Vec3f>& normals, const NormalProducts& products, double threshold)
      : mesh_(mesh),
        topology_(mesh.topology),
        normals_(normals),
        products_(products),
        threshold_(threshold),
        least_(threshold - product_rounding) {}

  /// Edge by edge: what is known already need not be computed. [E]
  [[nodiscard]] EdgeMarks by_edges(const Region& region) {
    EdgeMarks marks(topology_.edge_count(), 0);
    for (uint32_t e : region.edges()) {
      const float known = products_.empty() ? unknown : products_.get(e);
      const bool curved = known != unknown ? known < least_ : is_curved(e);
      marks[e] = curved ? 1 : 0;
    }
    return marks;
  }

  /// Face by face, of a region without curves: each face asks about all its edges, which costs less than finding out
  /// which it has asked about before. With the other edges of a face that has one of them, if that is asked. [E]
  [[nodiscard]] EdgeMarks by_faces(const Region& region, bool with_others) const {
    EdgeMarks found(topology_.edge_count(), 0);
    const uint32_t* const twin_of = topology_.twin.data();
    const uint32_t* const edge_of = topology_.edge.data();
    const Vec3f* const normals = normals_.data();
    const uint8_t* const has_edge = region.has_edge.data();
    uint8_t* const marks = found.data();
    const float least = least_in_floats_;
    const uint8_t spread = with_others ? 1 : 0;
    for (uint32_t f : region.faces) {
      const uint32_t* twin = &twin_of[size_t{3} * f];
      const uint32_t* edge = &edge_of[size_t{3} * f];
      const Vec3x4 others = at(normals, {Topology::face(twin[0]), Topology::face(twin[1]), Topology::face(twin[2]), f});
      const Mask4 curved = are_curved(splat<3>(others), others, least);
      std::array<uint8_t, 3> of_edge{};
      for (uint32_t i = 0; i < 3; ++i) of_edge[i] = static_cast<uint8_t>(curved[i] & has_edge[edge[i]]);
      const uint8_t of_face = (of_edge[0] | of_edge[1] | of_edge[2]) & spread;
      for (uint32_t i = 0; i < 3; ++i) marks[edge[i]] |= of_edge[i] | (of_face & has_edge[edge[i]]);
    }
    return found;
  }

 private:
  [[nodiscard]] bool is_curved(uint32_t e) {
    const uint32_t h = topology_.half_edge[e];
    if (topology_.kind[e] != EdgeKind::smooth) {
      if (topology_.kind[e] == EdgeKind::cut) return false;  // no curve: what lies beyond its ends is not known
      if (!curves_) curves_.emplace(topology_);
      return turns(mesh_, *curves_, h, threshold_);
    }
    const float found = product(h);
    if (!products_.empty()) products_.put(e, found);
    return found < least_;
  }

  /// Of the unit normals at a smooth edge.
  [[nodiscard]] float product(uint32_t h) const {
    const Vec3f n1 = normals_[Topology::face(h)];
    const Vec3f n2 = normals_[Topology::face(topology_.twin[h])];
    const float product = dot(n1, n2);
    return product != 0 || (has_normal(n1) && has_normal(n2)) ? product : flat;  // without a normal it is 0
  }

  const Mesh& mesh_;
  const Topology& topology_;
  const Buffer<Vec3f>& normals_;
  const NormalProducts& products_;
  double threshold_, least_;
  float least_in_floats_ = no_less_than(least_);  ///< a float is below both or none
  std::optional<CurveNeighbours> curves_;         ///< made when the first curve is met: there may be none
};

void grow_over_faces(const Topology& mesh, const Region& region, EdgeMarks& marks) {
  const EdgeMarks seeds = marks;
  for (uint32_t f : region.faces) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    const uint8_t any = seeds[edge[0]] | seeds[edge[1]] | seeds[edge[2]];
    for (uint32_t i = 0; i < 3; ++i) marks[edge[i]] |= any;
  }
  for (size_t e = 0; e < marks.size(); ++e) marks[e] &= region.has_edge[e];
}

void grow_over_vertices(const Topology& mesh, const Region& region, EdgeMarks& marks) {
  Buffer<uint8_t> touched(mesh.vertex_count, 0);
  const Buffer<uint32_t> edges = region.edges();
  for (uint32_t e : edges) {
    touched[mesh.origin[mesh.half_edge[e]]] |= marks[e];
    touched[mesh.tip(mesh.half_edge[e])] |= marks[e];
  }
  for (uint32_t e : edges) marks[e] |= touched[mesh.origin[mesh.half_edge[e]]] | touched[mesh.tip(mesh.half_edge[e])];
}

}  // namespace

void grow(const Topology& mesh, Growth growth, const Region& region, EdgeMarks& marks) {
  if (growth == Growth::faces) grow_over_faces(mesh, region, marks);
  if (growth == Growth::vertices) grow_over_vertices(mesh, region, marks);
}

EdgeMarks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, const NormalProducts& products, double threshold,
                      Growth growth, const Region& region) {
  CurvedFinder finder(mesh, normals, products, threshold);
  const bool may_go_by_faces = products.empty() && !region.has_curves;
  if (may_go_by_faces && growth == Growth::faces) return finder.by_faces(region, true);
  EdgeMarks marks = may_go_by_faces ? finder.by_faces(region, false) : finder.by_edges(region);
  grow(mesh.topology, growth, region, marks);
  return marks;
}

}  // namespace papilio
