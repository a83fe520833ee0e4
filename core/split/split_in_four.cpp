#include "split/split_in_four.h"

#include <algorithm>
#include <array>

#include "base/ids.h"
#include "base/index_range.h"
#include "base/parallel.h"
#include "mesh/four_children.h"

namespace papilio {
namespace {

/// Rule for one face and its four children.
class FourRule {
 public:
  /// For a mesh with `vertices` vertices and `edges` edges.
  FourRule(uint32_t vertices, uint32_t edges) : vertices_(vertices), inner_edges_(2 * edges) {}

  /// Writes corners and twins of the children of face f.
  void split(FaceId f, const uint32_t* corner, const uint32_t* twin, const uint32_t* edge, uint32_t* child_origin,
             uint32_t* child_twin) const {
    put_corners_of_four({corner[0], corner[1], corner[2]},
                        {vertices_ + edge[0], vertices_ + edge[1], vertices_ + edge[2]}, child_origin);
    put_twins_of_four(12 * f, {against_first(twin[0]), against_first(twin[1]), against_first(twin[2])},
                      {against_second(twin[0]), against_second(twin[1]), against_second(twin[2])}, child_twin);
  }

  /// Writes edges of the children of face f.
  void number_edges(FaceId f, const uint32_t* corner, const uint32_t* edge, uint32_t* child_edge) const {
    // 1 if the half at the half-edge's tip comes first.
    const uint32_t down[3] = {corner[0] > corner[1] ? 1U : 0U, corner[1] > corner[2] ? 1U : 0U,
                              corner[2] > corner[0] ? 1U : 0U};
    const OfSides first{2 * edge[0] + down[0], 2 * edge[1] + down[1], 2 * edge[2] + down[2]};
    put_edges_of_four(first, {first[0] ^ 1, first[1] ^ 1, first[2] ^ 1}, inner_edge(f), child_edge);
  }

  /// Returns the first of the three edges inside face f.
  [[nodiscard]] uint32_t inner_edge(FaceId f) const { return inner_edges_ + 3 * f; }

 private:
  /// Returns the child half-edge opposite to a half of a half-edge with this twin.
  static uint32_t against_first(uint32_t twin) { return twin == none ? none : second_half(twin); }
  static uint32_t against_second(uint32_t twin) { return twin == none ? none : first_half(twin); }

  uint32_t vertices_;
  uint32_t inner_edges_;
};

/// Returns an empty level below one with these numbers of vertices and edges, with room for `half_edges` half-edges.
Topology level_below(const Topology& mesh, uint32_t vertices, uint32_t edges, size_t half_edges) {
  Topology below;
  below.vertex_count = vertices + edges;
  below.pinched = mesh.pinched;
  below.darts = mesh.darts;
  below.shape = mesh.shape;
  below.origin.resize_for_overwrite(half_edges);
  below.twin.resize_for_overwrite(half_edges);
  return below;
}

template <bool numbers_edges, class Numbers>
class FourSplitter {
 public:
  FourSplitter(const Topology& mesh, const IndexRange& faces, const Numbers& numbers)
      : mesh_(mesh), faces_(faces), numbers_(numbers), rule_(mesh.vertex_count, numbers.edge_count()) {}

  /// Splits the faces; reserves memory for the children of `room` faces.
  Topology run(uint32_t room, int threads) {
    child_ = level_below(mesh_, mesh_.vertex_count, mesh_.edge_count(), size_t{12} * room);
    if (numbers_edges) {
      child_.edge.resize_for_overwrite(size_t{12} * room);
      child_.half_edge.resize_for_overwrite(rule_.inner_edge(room));
    }
    for_each_part(parts_of(faces_.size(), threads), faces_.size(), [this](uint32_t, uint32_t first, uint32_t last) {
      for (uint32_t i = first; i < last; ++i) split_face(i, faces_[i]);
    });
    return std::move(child_);
  }

 private:
  void split_face(uint32_t number, FaceId f) {
    const HalfEdgeId h = 3 * f;
    const uint32_t base = 12 * number;
    const OfSides twin{numbers_.half_edge(mesh_.twin[h]), numbers_.half_edge(mesh_.twin[h + 1]),
                       numbers_.half_edge(mesh_.twin[h + 2])};
    rule_.split(number, &mesh_.origin[h], twin.data(), &mesh_.edge[h], &child_.origin[base], &child_.twin[base]);
    if (!numbers_edges) return;
    const OfSides edge{numbers_.edge(mesh_.edge[h]), numbers_.edge(mesh_.edge[h + 1]),
                       numbers_.edge(mesh_.edge[h + 2])};
    uint32_t* child_edge = &child_.edge[base];
    rule_.number_edges(number, &mesh_.origin[h], edge.data(), child_edge);
    constexpr OfSides first_half_edge{0, 4, 8}, second_half_edge{3, 7, 2};
    for (uint32_t i = 0; i < 3; ++i) {
      if (!is_named_after(3 * number + i, twin[i], h + i)) continue;
      child_.half_edge[child_edge[first_half_edge[i]]] = base + first_half_edge[i];
      child_.half_edge[child_edge[second_half_edge[i]]] = base + second_half_edge[i];
    }
    put(&child_.half_edge[rule_.inner_edge(number)], base + 11, base + 9, base + 10);
  }

  /// Returns whether the edge's `half_edge` is this one: the lower of both, by its number and that of its twin. Without
  /// a twin, it is the one stored in the mesh.
  [[nodiscard]] bool is_named_after(uint32_t number, uint32_t twin, uint32_t half_edge) const {
    if (twin == none) [[unlikely]]
      return mesh_.half_edge[mesh_.edge[half_edge]] == half_edge;
    return number < twin;
  }

  const Topology& mesh_;
  const IndexRange faces_;
  const Numbers numbers_;
  const FourRule rule_;
  Topology child_;
};

template <bool numbers_edges>
Topology split_all(const Topology& mesh, int threads) {
  return FourSplitter<numbers_edges, OwnNumbers>(mesh, IndexRange(mesh.face_count()), OwnNumbers(mesh.edge_count()))
      .run(mesh.face_count(), threads);
}

/// Writes the children of the sentinel face, which stands for all faces outside the part.
void write_others(const Part& part, Topology& children) {
  const uint32_t base = 12 * part.other_face();
  const EdgeId edge = 2 * part.other_edge();
  const uint32_t inner = children.edge_count() - 3;
  std::fill_n(&children.origin[base], 12, 0U);
  put_twins_of_four(base, {base, base + 4, base + 8}, {base + 3, base + 7, base + 2}, &children.twin[base]);
  put_edges_of_four({edge, edge, edge}, {edge + 1, edge + 1, edge + 1}, inner, &children.edge[base]);
  put(&children.half_edge[edge], base, base + 3);
  put(&children.half_edge[inner], base + 11, base + 9, base + 10);
}

}  // namespace

Topology split_in_four(const Topology& mesh, int threads) {
  Topology children = split_all<true>(mesh, threads);
  const uint32_t edges = mesh.edge_count();
  children.kind.resize_for_overwrite(children.edge_count());
  for (EdgeId e = 0; e < edges; ++e) children.kind[2 * e] = children.kind[2 * e + 1] = mesh.kind[e];
  std::fill(children.kind.begin() + 2 * edges, children.kind.end(), EdgeKind::smooth);
  return children;
}

Topology split_part_in_four(const Topology& mesh, const Part& part, int threads) {
  Topology children = FourSplitter<true, PartNumbers>(mesh, IndexRange(part.faces.numbers()), PartNumbers(part))
                          .run(part.other_face() + 1, threads);
  write_others(part, children);
  children.kind.assign(children.edge_count(), EdgeKind::smooth);
  return children;
}

Topology split_last_in_four(const Topology& mesh, int threads) { return split_all<false>(mesh, threads); }

Topology split_last_in_sixteen(const Topology& mesh, int threads) {
  const uint32_t vertices = mesh.vertex_count + mesh.edge_count();
  const uint32_t edges = 2 * mesh.edge_count() + mesh.half_edge_count();
  const FourRule rule(mesh.vertex_count, mesh.edge_count());
  const FourRule rule_below(vertices, edges);
  Topology below = level_below(mesh, vertices, edges, size_t{16} * mesh.half_edge_count());
  for_each_part(parts_of(mesh.face_count(), threads), mesh.face_count(), [&](uint32_t, uint32_t first, uint32_t last) {
    uint32_t origin[12];  // values of the four children
    uint32_t twin[12];
    uint32_t edge[12];
    for (FaceId f = first; f < last; ++f) {
      const HalfEdgeId h = 3 * f;
      rule.split(f, &mesh.origin[h], &mesh.twin[h], &mesh.edge[h], origin, twin);
      rule.number_edges(f, &mesh.origin[h], &mesh.edge[h], edge);
      for (uint32_t c = 0; c < 4; ++c) {
        const size_t base = size_t{12} * (4 * f + c);
        rule_below.split(4 * f + c, &origin[3 * c], &twin[3 * c], &edge[3 * c], &below.origin[base], &below.twin[base]);
      }
    }
  });
  return below;
}

}  // namespace papilio
