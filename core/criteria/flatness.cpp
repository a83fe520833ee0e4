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

[[nodiscard, gnu::always_inline]] inline Mask4 have_normals(const Vec3x4& one, const Vec3x4& other) {
  return ((one.x != 0) | (one.y != 0) | (one.z != 0)) & ((other.x != 0) | (other.y != 0) | (other.z != 0));
}
/// Between four faces and four others, by their normals.
[[nodiscard, gnu::always_inline]] inline Mask4 are_curved(const Vec3x4& one, const Vec3x4& other, float least) {
  return (dot(one, other) < least) & have_normals(one, other);
}

/// Marks the edges of a region without curves that are not flat, face by face.
struct CurvedMarker {
  const uint32_t *twin_of, *edge_of;  ///< [H]
  const Vec3f* normals;               ///< [F]
  const uint8_t* has_edge;            ///< [E] of the region
  uint8_t* marks;                     ///< [E]
  float least;                        ///< of a flat edge's product
  uint8_t spread;                     ///< 1 to mark the other edges of a face at one, too; else 0

  /// What the four children of faces mark; `faces` has all of these.
  [[gnu::always_inline]] void mark_fours(const Buffer<uint32_t>& faces) const {
    constexpr size_t ahead = 48;  // faces until what is asked for is there
    const uint32_t* first = faces.data();
    const size_t count = faces.size();
    for (size_t i = 0; i < count; i += 4) {
      prefetch_across(first[std::min(i + ahead, count - 4)]);
      mark_four(first[i]);
    }
  }

  /// Has the cache load the normals of the faces across the sides of the parent of four.
  [[gnu::always_inline]] void prefetch_across(uint32_t first) const {
    const uint32_t* twin = &twin_of[size_t{3} * first];
    for (uint32_t h : {0, 4, 8}) __builtin_prefetch(normals + Topology::face(twin[h]));
  }

  [[gnu::always_inline]] void mark_four(uint32_t first) const {
    const uint32_t* twin = &twin_of[size_t{3} * first];
    const uint32_t* edge = &edge_of[size_t{3} * first];
    const Vec3x4 own = at(normals, {first, first + 1, first + 2, first + 3});
    // Of each of the first three children what is across two of its sides, and what is beside it: the fourth.
    const auto across = [&](uint32_t h0, uint32_t h1, uint32_t h2) __attribute__((always_inline)) {
      const uint32_t last = Topology::face(twin[h2]);
      return at(normals, {Topology::face(twin[h0]), Topology::face(twin[h1]), last, last});
    };
    constexpr std::array<std::array<uint8_t, 3>, 3> half_edges{{{0, 3, 7}, {2, 4, 8}, {11, 9, 10}}};
    const Vec3x4 across_one = across(0, 3, 7);
    const Vec3x4 across_other = across(2, 4, 8);
    const Vec3x4 inner = splat<3>(own);
    const Float4 of_one_side = dot(own, across_one);
    const Float4 of_other_side = dot(own, across_other);
    const Float4 of_inside = dot(own, inner);
    Mask4 one_side = of_one_side < least;
    Mask4 other_side = of_other_side < least;
    Mask4 inside = of_inside < least;
    // Without a normal a product is 0; else it hardly is.
    if (is_any((of_one_side == 0) | (of_other_side == 0) | (of_inside == 0))) [[unlikely]] {
      one_side &= have_normals(own, across_one);
      other_side &= have_normals(own, across_other);
      inside &= have_normals(own, inner);
    }
    const auto of_fourth = static_cast<uint8_t>((inside[0] | inside[1] | inside[2]) & spread);
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t one = edge[half_edges[0][c]];
      const uint32_t other = edge[half_edges[1][c]];
      const auto of_one = static_cast<uint8_t>(one_side[c] & has_edge[one]);
      const auto of_other = static_cast<uint8_t>(other_side[c] & has_edge[other]);
      const auto of_inner = static_cast<uint8_t>(inside[c] & 1);
      const auto of_child = static_cast<uint8_t>((of_one | of_other | of_inner) & spread);
      marks[one] |= of_one | (of_child & has_edge[one]);
      marks[other] |= of_other | (of_child & has_edge[other]);
      marks[edge[half_edges[2][c]]] = of_inner | of_child | of_fourth;
    }
  }

  /// What a face marks.
  [[gnu::always_inline]] void mark(uint32_t f) const {
    const uint32_t* twin = &twin_of[size_t{3} * f];
    const uint32_t* edge = &edge_of[size_t{3} * f];
    const Vec3x4 others = at(normals, {Topology::face(twin[0]), Topology::face(twin[1]), Topology::face(twin[2]), f});
    const Mask4 curved = are_curved(splat<3>(others), others, least);
    std::array<uint8_t, 3> of_edge{};
    for (uint32_t i = 0; i < 3; ++i) of_edge[i] = static_cast<uint8_t>(curved[i] & has_edge[edge[i]]);
    const uint8_t of_face = (of_edge[0] | of_edge[1] | of_edge[2]) & spread;
    for (uint32_t i = 0; i < 3; ++i) marks[edge[i]] |= of_edge[i] | (of_face & has_edge[edge[i]]);
  }
};

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
      const float known = products_.get(e);
      const bool curved = known != unknown ? known < least_ : is_curved(e);
      marks[e] = curved ? 1 : 0;
    }
    return marks;
  }

  /// Face by face, as they lie in memory: each asks about all its edges, which costs less than finding out which it has
  /// asked about before. [E]
  [[nodiscard]] EdgeMarks by_faces(const Region& region) {
    auto found = Buffer<uint8_t>::for_overwrite(topology_.edge_count());
    for (uint32_t f : region.faces) look_at(f, found.data());
    EdgeMarks marks(found.size(), 0);
    for (size_t e = 0; e < marks.size(); ++e) marks[e] = found[e] & region.has_edge[e];
    return marks;
  }

  /// The same of a region without curves; with the other edges of a face that has one of them, if that is asked. [E]
  [[nodiscard]] EdgeMarks by_faces(const Region& region, bool with_others) {
    EdgeMarks marks(topology_.edge_count(), 0);
    const CurvedMarker marker{.twin_of = topology_.twin.data(),
                              .edge_of = topology_.edge.data(),
                              .normals = normals_.data(),
                              .has_edge = region.has_edge.data(),
                              .marks = marks.data(),
                              .least = least_in_floats_,
                              .spread = static_cast<uint8_t>(with_others ? 1 : 0)};
    if (region.is_in_fours)
      marker.mark_fours(region.faces);
    else
      for (uint32_t f : region.faces) marker.mark(f);
    return marks;
  }

 private:
  void look_at(uint32_t f, uint8_t* found) {
    const uint32_t* edge = &topology_.edge[size_t{3} * f];
    const auto is_smooth = [&](uint32_t i) { return topology_.kind[edge[i]] == EdgeKind::smooth; };
    if (!is_smooth(0) || !is_smooth(1) || !is_smooth(2)) [[unlikely]] {
      for (uint32_t i = 0; i < 3; ++i) found[edge[i]] = is_curved(edge[i]) ? 1 : 0;
      return;
    }
    const Mask4 curved = are_curved_at(f);
    for (uint32_t i = 0; i < 3; ++i) found[edge[i]] = curved[i] & 1;
  }

  /// Of the three smooth edges of a face; the fourth means nothing.
  [[nodiscard]] Mask4 are_curved_at(uint32_t f) const {
    const uint32_t* twin = &topology_.twin[size_t{3} * f];
    const Vec3x4 others = at(normals_, {Topology::face(twin[0]), Topology::face(twin[1]), Topology::face(twin[2]), f});
    return are_curved(splat<3>(others), others, least_in_floats_);
  }

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

EdgeMarks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, const NormalProducts& products, double threshold,
                      const Region& region) {
  CurvedFinder finder(mesh, normals, products, threshold);
  if (!products.empty()) return finder.by_edges(region);
  return region.has_curves ? finder.by_faces(region) : finder.by_faces(region, false);
}

void grow(const Topology& mesh, Growth growth, const Region& region, EdgeMarks& marks) {
  if (growth == Growth::faces) grow_over_faces(mesh, region, marks);
  if (growth == Growth::vertices) grow_over_vertices(mesh, region, marks);
}

EdgeMarks find_curved_and_grow(const Mesh& mesh, const Buffer<Vec3f>& normals, const NormalProducts& products,
                               double threshold, Growth growth, const Region& region) {
  if (products.empty() && !region.has_curves && growth == Growth::faces)
    return CurvedFinder(mesh, normals, products, threshold).by_faces(region, true);
  EdgeMarks marks = find_curved(mesh, normals, products, threshold, region);
  grow(mesh.topology, growth, region, marks);
  return marks;
}

}  // namespace papilio
