#include "criteria/budget.h"

#include "base/ids.h"

#include <algorithm>
#include <bit>

namespace papilio {
namespace {

/// Returns an integer key in the order of the errors; equal errors have equal keys.
uint32_t rank_of(float error) {
  constexpr uint32_t sign = 1U << 31U;
  const auto bits = std::bit_cast<uint32_t>(error + 0.0F);  // -0 + 0 = 0
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// Returns the key of the largest error whose edges do not all fit, if `room` faces are given to edges in descending
/// order of their errors. Must not be called if all edges fit.
uint32_t largest_that_does_not_fit(std::span<const WeighedEdge> edges, uint64_t room) {
  Buffer<WeighedEdge> left(edges.begin(), edges.end());
  uint32_t known = 0;  // leading digits of the key
  uint32_t shift = 32;
  for (const uint32_t bits : {12U, 10U, 10U}) {  // bits of each digit, the highest first
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
  for (FaceId f : region.faces)
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) ++faces[mesh.edge[h]];
  for (EdgeId e : region.edges())
    if (errors[e] >= least) edges.push_back({errors[e], faces[e]});
}

float threshold_within(std::span<const WeighedEdge> edges, float least, uint64_t faces, uint64_t budget) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Buffer<WeighedEdge> candidates;
  candidates.reserve(edges.size());
  uint64_t all = faces;
  for (const WeighedEdge& e : edges) {
    if (!(e.error >= least)) continue;
    candidates.push_back(e);
    all += e.faces;
  }
  if (all <= budget) return least;
  if (faces > budget) return infinity;
  // Edges of equal errors are split together: edges that require each other share an error.
  const uint32_t too_much = largest_that_does_not_fit(candidates, budget - faces);
  float threshold = infinity;
  for (const WeighedEdge& e : candidates)
    if (rank_of(e.error) > too_much) threshold = std::min(threshold, e.error);
  return threshold;
}

}  // namespace papilio
