#include "split_in_four.h"

#include <algorithm>

#include "parallel.h"

namespace papilio {
namespace {

template <bool numbers_edges>
class FourSplitter {
 public:
  explicit FourSplitter(const Topology& mesh)
      : mesh_(mesh), vertices_(mesh.vertex_count), inner_edges_(2 * mesh.edge_count()) {}

  Topology run(int threads) {
    child_.vertex_count = vertices_ + mesh_.edge_count();
    child_.pinched = mesh_.pinched;
    child_.darts = mesh_.darts;
    const size_t half_edges = size_t{4} * mesh_.half_edge_count();
    child_.origin.resize(half_edges);
    child_.twin.resize(half_edges);
    if (numbers_edges) {
      child_.edge.resize(half_edges);
      child_.half_edge.resize(inner_edges_ + mesh_.half_edge_count());
      child_.kind.resize(child_.half_edge.size());
    }
    const uint32_t parts = parts_of(mesh_.face_count(), threads);
    for_each_part(parts, mesh_.face_count(), [this](uint32_t, uint32_t first, uint32_t last) {
      for (uint32_t f = first; f < last; ++f) split_face(f);
    });
    if (numbers_edges)
      for_each_part(parts, mesh_.edge_count(), [this](uint32_t, uint32_t first, uint32_t last) {
        for (uint32_t e = first; e < last; ++e) split_edge(e);
      });
    return std::move(child_);
  }

 private:
  void split_edge(uint32_t e) {
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t down = mesh_.origin[h] > mesh_.tip(h) ? 1 : 0;
    child_.half_edge[2 * e + down] = first_half(h);
    child_.half_edge[2 * e + 1 - down] = second_half(h);
    child_.kind[2 * e] = child_.kind[2 * e + 1] = mesh_.kind[e];
  }

  void split_face(uint32_t f) {
    const uint32_t h = 3 * f;
    const uint32_t* corner = &mesh_.origin[h];
    const uint32_t* twin = &mesh_.twin[h];
    const uint32_t* edge = &mesh_.edge[h];
    const uint32_t base = 12 * f;

    const uint32_t middle[3] = {vertices_ + edge[0], vertices_ + edge[1], vertices_ + edge[2]};
    put(&child_.origin[base], corner[0], middle[0], middle[2],  //
        middle[0], corner[1], middle[1],                        //
        middle[2], middle[1], corner[2],                        //
        middle[0], middle[1], middle[2]);
    put(&child_.twin[base], against_first(twin[0]), base + 11, against_second(twin[2]),  //
        against_second(twin[0]), against_first(twin[1]), base + 9,                       //
        base + 10, against_second(twin[1]), against_first(twin[2]),                      //
        base + 5, base + 6, base + 1);
    if (numbers_edges) number_edges(f);
  }

  void number_edges(uint32_t f) {
    const uint32_t h = 3 * f;
    const uint32_t* corner = &mesh_.origin[h];
    const uint32_t* edge = &mesh_.edge[h];
    const uint32_t base = 12 * f;
    // Whether the half at the half-edge's tip comes first.
    const uint32_t down[3] = {corner[0] > corner[1] ? 1U : 0U, corner[1] > corner[2] ? 1U : 0U,
                              corner[2] > corner[0] ? 1U : 0U};
    const uint32_t first[3] = {2 * edge[0] + down[0], 2 * edge[1] + down[1], 2 * edge[2] + down[2]};
    const uint32_t second[3] = {first[0] ^ 1, first[1] ^ 1, first[2] ^ 1};
    const uint32_t inner = inner_edges_ + h;
    put(&child_.edge[base], first[0], inner, second[2],  //
        second[0], first[1], inner + 1,                  //
        inner + 2, second[1], first[2],                  //
        inner + 1, inner + 2, inner);
    const uint32_t at[3] = {base + 11, base + 9, base + 10};
    std::copy_n(at, 3, &child_.half_edge[inner]);
    std::fill_n(&child_.kind[inner], 3, EdgeKind::smooth);
  }

  /// One after the other: built in an array first and then copied, they are waited for.
  template <class... Numbers>
  static void put(uint32_t* at, Numbers... numbers) {
    static_assert(sizeof...(numbers) == 12);
    ((*at++ = numbers), ...);
  }

  /// The child half-edges that run against the halves of a half-edge with this twin.
  static uint32_t against_first(uint32_t twin) { return twin == none ? none : second_half(twin); }
  static uint32_t against_second(uint32_t twin) { return twin == none ? none : first_half(twin); }

  const Topology& mesh_;
  const uint32_t vertices_;
  const uint32_t inner_edges_;  ///< the first edge inside a face
  Topology child_;
};

}  // namespace

Topology split_in_four(const Topology& mesh, int threads) { return FourSplitter<true>(mesh).run(threads); }

Topology split_last_in_four(const Topology& mesh, int threads) { return FourSplitter<false>(mesh).run(threads); }

}  // namespace papilio
