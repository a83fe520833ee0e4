#include "detail/seams.h"

#include <algorithm>

#include "mesh/attributes.h"
#include "mesh/crease.h"
#include "mesh/curve.h"

namespace papilio {
namespace {

/// Gives each fan of faces its own vertex, in the order of their lowest half-edges. Fans end where there is no twin.
void part_vertices(CutSurface& cut) {
  Topology& t = cut.topology;
  const auto count = static_cast<uint32_t>(t.twin.size());
  t.origin.assign(count, none);
  for (uint32_t h = 0; h < count; ++h) {
    if (t.origin[h] != none) continue;
    const auto vertex = static_cast<uint32_t>(cut.half_edge.size());
    cut.half_edge.push_back(h);
    uint32_t at = h;
    while (at != none && t.origin[at] == none) {  // counter-clockwise
      t.origin[at] = vertex;
      at = t.twin[Topology::previous(at)];
    }
    for (at = t.twin[h]; at != none; at = t.twin[at]) {  // clockwise
      at = Topology::next(at);
      if (t.origin[at] != none) break;
      t.origin[at] = vertex;
    }
  }
  t.vertex_count = static_cast<uint32_t>(cut.half_edge.size());
}

/// Numbers the edges in the order in which the faces first use them.
void number_edges_of(Topology& cut, const Topology& whole) {
  cut.edge.resize_for_overwrite(cut.twin.size());
  for (uint32_t h = 0; h < cut.twin.size(); ++h) {
    const uint32_t twin = cut.twin[h];
    if (twin != none && twin < h) {
      cut.edge[h] = cut.edge[twin];
      continue;
    }
    cut.edge[h] = cut.edge_count();
    cut.half_edge.push_back(h);
    cut.kind.push_back(twin == none ? EdgeKind::boundary : whole.kind[whole.edge[h]]);
  }
}

}  // namespace

std::vector<uint32_t> seam_edges(const Mesh& mesh) {
  std::vector<uint32_t> seams;
  const Topology& t = mesh.topology;
  for (uint32_t e = 0; e < t.edge_count(); ++e)
    if (const uint32_t h = t.half_edge[e]; t.twin[h] != none && is_seam(t, mesh.attributes, h)) seams.push_back(e);
  return seams;
}

CutSurface cut_at_seams(const Mesh& mesh, const std::vector<uint32_t>& seams) {
  const Topology& t = mesh.topology;
  CutSurface cut;
  cut.topology.twin = t.twin;
  for (const uint32_t e : seams) {
    const uint32_t h = t.half_edge[e];
    cut.topology.twin[t.twin[h]] = none;
    cut.topology.twin[h] = none;
  }
  part_vertices(cut);
  number_edges_of(cut.topology, t);

  const VertexDegrees curves(
      t, [&](uint32_t e) { return t.kind[e] != EdgeKind::smooth || std::ranges::binary_search(seams, e); });
  const VertexDegrees cut_curves(cut.topology, [&](uint32_t e) { return cut.topology.kind[e] != EdgeKind::smooth; });
  for (uint32_t v = 0; v < cut.topology.vertex_count; ++v) {
    const uint32_t whole = t.origin[cut.half_edge[v]];
    if (cut_curves.degree[v] != 2) continue;
    if (curves.degree[whole] != 2 || std::ranges::binary_search(t.shape.corners, whole))
      cut.topology.shape.corners.push_back(v);
  }
  cut.topology.darts = find_darts(cut.topology);
  return cut;
}

}  // namespace papilio
