#include "mesh/curve.h"

namespace papilio {

CurveNeighbours::CurveNeighbours(const Topology& mesh)
    : mesh_(mesh), degree_(mesh.vertex_count, 0), neighbours_(mesh.vertex_count, 0) {
  const auto join = [&](uint32_t v, uint32_t other) {
    if (degree_[v] < 3) ++degree_[v];
    neighbours_[v] ^= other;
  };
  for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.kind[e] == EdgeKind::smooth || mesh.kind[e] == EdgeKind::cut) continue;
    const uint32_t a = mesh.origin[mesh.half_edge[e]];
    const uint32_t b = mesh.tip(mesh.half_edge[e]);
    join(a, b);
    join(b, a);
  }
  for (uint32_t v : mesh.shape.corners) degree_[v] = ends_here;
}

uint32_t CurveNeighbours::before(uint32_t h) const {
  const uint32_t vertex = mesh_.origin[h];
  if (passes_through(vertex)) return neighbours_[vertex] ^ mesh_.tip(h);
  if (mesh_.kind[mesh_.edge[h]] != EdgeKind::boundary || degree_[vertex] == ends_here) return none;
  uint32_t incoming = Topology::previous(h);
  while (mesh_.twin[incoming] != none) incoming = Topology::previous(mesh_.twin[incoming]);
  return mesh_.origin[incoming];
}

uint32_t CurveNeighbours::after(uint32_t h) const {
  const uint32_t vertex = mesh_.tip(h);
  if (passes_through(vertex)) return neighbours_[vertex] ^ mesh_.origin[h];
  if (mesh_.kind[mesh_.edge[h]] != EdgeKind::boundary || degree_[vertex] == ends_here) return none;
  uint32_t outgoing = Topology::next(h);
  while (mesh_.twin[outgoing] != none) outgoing = Topology::next(mesh_.twin[outgoing]);
  return mesh_.tip(outgoing);
}

}  // namespace papilio
