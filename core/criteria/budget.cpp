#include "criteria/budget.h"

#include <algorithm>
#include <bit>

namespace papilio {
namespace {

/// Whole numbers in the order of the errors; those that are equal have the same.
uint32_t rank_of(float error) {
  constexpr uint32_t sign = 1U << 31U;
  const auto bits = std::bit_cast<uint32_t>(error + 0.0F);  // of two zeros one
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// The rank of the largest error of which not all edges fit, where from the largest error on so many faces do; not all
/// edges must.
uint32_t largest_that_does_not_fit(std::span<const WeighedEdge> edges, uint64_t room) {
  Buffer<WeighedEdge> left(edges.begin(), edges.end());
  uint32_t known = 0;  // its digits so far
  uint32_t shift = 32;
  for (const uint32_t bits : {12U, 10U, 10U}) {  // of the digits, from the highest on
    shift -= bits;
    const auto digit_of = [&](const WeighedEdge& e) { return rank_of(e.error) >> shift & ((1U << bits) - 1); };
    Buffer<uint64_t> faces(size_t{1} << bits, 0);
    for (const WeighedEdge& e : left) faces[digit_of(e)] += e.faces;
    auto digit = static_cast<uint32_t>(faces.size() - 1);
    for (; digit > 0 && faces[digit] <= room; --digit) room -= faces[digit];
    known = known << bits | digit;
    erase_if(left, [&](const WeighedEdge& e) { return digit_of(e) != digit; });
  }
  return known;
}

}  // namespace

void append_edges(const Topology& mesh, const Region& region, const Buffer<float>& errors, float least,
                  Buffer<WeighedEdge>& edges) {
  Buffer<uint32_t> faces(mesh.edge_count(), 0);
  for (uint32_t f : region.faces)
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) ++faces[mesh.edge[h]];
  for (uint32_t e : region.edges())
    if (errors[e] >= least) edges.push_back({errors[e], faces[e]});
}

float threshold_within(std::span<const WeighedEdge> edges, float least, uint64_t faces, uint64_t budget) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Buffer<WeighedEdge> wanted;
  wanted.reserve(edges.size());
  uint64_t all = faces;
  for (const WeighedEdge& e : edges) {
    if (!(e.error >= least)) continue;
    wanted.push_back(e);
    all += e.faces;
  }
  if (all <= budget) return least;
  if (faces > budget) return infinity;
  // Equal errors go together: what forces each other has one error.
  const uint32_t too_much = largest_that_does_not_fit(wanted, budget - faces);
  float threshold = infinity;
  for (const WeighedEdge& e : wanted)
    if (rank_of(e.error) > too_much) threshold = std::min(threshold, e.error);
  return threshold;
}

}  // namespace papilio
