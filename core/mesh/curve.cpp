#include "mesh/curve.h"

namespace papilio {

CurveNeighbours::CurveNeighbours(const Topology& mesh)
    : mesh_(mesh),
      curves_(mesh, [&](EdgeId e) { return mesh.kind[e] != EdgeKind::smooth && mesh.kind[e] != EdgeKind::cut; }) {
  for (VertexId v : mesh.shape.corners) curves_.degree[v] = ends_here;
}

uint32_t CurveNeighbours::before(HalfEdgeId h) const {
  const VertexId vertex = mesh_.origin[h];
  if (passes_through(vertex)) return curves_.neighbours[vertex] ^ mesh_.tip(h);
  if (mesh_.kind[mesh_.edge[h]] != EdgeKind::boundary || curves_.degree[vertex] == ends_here) return none;
  HalfEdgeId incoming = h.previous();
  while (mesh_.twin[incoming] != none) incoming = Topology::previous(mesh_.twin[incoming]);
  return mesh_.origin[incoming];
}

uint32_t CurveNeighbours::after(HalfEdgeId h) const {
  const VertexId vertex = mesh_.tip(h);
  if (passes_through(vertex)) return curves_.neighbours[vertex] ^ mesh_.origin[h];
  if (mesh_.kind[mesh_.edge[h]] != EdgeKind::boundary || curves_.degree[vertex] == ends_here) return none;
  HalfEdgeId outgoing = h.next();
  while (mesh_.twin[outgoing] != none) outgoing = Topology::next(mesh_.twin[outgoing]);
  return mesh_.tip(outgoing);
}

}  // namespace papilio
