#include "tests/support/invariants.h"

#include <algorithm>
#include <vector>

namespace papilio::test {
namespace {

/// An edge by its two vertices, with the number of faces in each direction.
struct Uses {
  std::pair<uint32_t, uint32_t> ends;
  uint32_t forward = 0, backward = 0;
};

/// Returns the edges sorted by ends.
std::vector<Uses> uses_of_edges(const TriangleMesh& mesh) {
  std::vector<Uses> all;
  all.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = t[i];
      const uint32_t b = t[(i + 1) % 3];
      all.push_back(a < b ? Uses{{a, b}, 1, 0} : Uses{{b, a}, 0, 1});
    }
  }
  std::ranges::sort(all, {}, &Uses::ends);
  std::vector<Uses> edges;
  for (const Uses& use : all) {
    if (edges.empty() || edges.back().ends != use.ends) edges.push_back({use.ends, 0, 0});
    edges.back().forward += use.forward;
    edges.back().backward += use.backward;
  }
  return edges;
}

}  // namespace

EdgeCensus count_edges(const TriangleMesh& mesh) {
  EdgeCensus census;
  for (const Uses& uses : uses_of_edges(mesh)) {
    ++census.edges;
    if (uses.forward + uses.backward == 1) ++census.boundary;
    if (uses.forward > 1 || uses.backward > 1) ++census.irregular;
  }
  return census;
}

int64_t euler_characteristic(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (uint32_t v : t) used[v] = true;
  return std::ranges::count(used, true) - static_cast<int64_t>(count_edges(mesh).edges) +
         static_cast<int64_t>(mesh.triangles.size());
}

::testing::AssertionResult is_consistent(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  const auto fail = [](const std::string& what, uint32_t index) {
    return ::testing::AssertionFailure() << what << ", index " << index;
  };
  if (mesh.positions.size() != topology.vertex_count) return fail("positions", topology.vertex_count);
  const TriangleMesh triangles = mesh.triangles();
  for (uint32_t f = 0; f < triangles.triangles.size(); ++f) {
    const Triangle t = triangles.triangles[f];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return fail("degenerate face", f);
    for (uint32_t v : t)
      if (v >= topology.vertex_count) return fail("vertex out of range in face", f);
  }
  const auto uses = uses_of_edges(triangles);
  if (uses.size() != topology.edge_count()) return fail("edge count", topology.edge_count());
  if (euler_characteristic(triangles) != topology.euler_characteristic())
    return fail("unused vertices", topology.vertex_count);
  std::vector<uint32_t> halves(topology.edge_count(), 0);
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    const uint32_t a = topology.origin[h];
    const uint32_t b = topology.tip(h);
    const uint32_t e = topology.edge[h];
    if (e >= topology.edge_count()) return fail("edge out of range at half-edge", h);
    ++halves[e];
    const uint32_t r = topology.half_edge[e];
    if (std::minmax(a, b) != std::minmax(topology.origin[r], topology.tip(r))) return fail("edge of half-edge", h);
    const Uses use = *std::ranges::lower_bound(uses, std::pair(std::min(a, b), std::max(a, b)), {}, &Uses::ends);
    const bool smooth = use.forward == 1 && use.backward == 1;
    if (smooth) {
      const uint32_t t = topology.twin[h];
      if (t == none || topology.twin[t] != h || topology.origin[t] != b || topology.tip(t) != a)
        return fail("twin of half-edge", h);
      if (topology.kind[e] != EdgeKind::smooth && topology.kind[e] != EdgeKind::crease)
        return fail("kind of smooth edge", e);
    } else {
      if (topology.twin[h] != none) return fail("twin at a curve, half-edge", h);
      const auto expected = use.forward + use.backward == 1 ? EdgeKind::boundary : EdgeKind::shared;
      if (topology.kind[e] != expected) return fail("kind of edge", e);
    }
  }
  for (uint32_t e = 0; e < topology.edge_count(); ++e)
    if (halves[e] == 0) return fail("edge without half-edge", e);
  return ::testing::AssertionSuccess();
}

}  // namespace papilio::test
