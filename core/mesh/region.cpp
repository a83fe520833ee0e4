#include "mesh/region.h"

#include "base/ids.h"

#include <algorithm>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{Buffer<uint32_t>(mesh.face_count()), Marks(mesh.edge_count(), 1)};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  return region;
}

Buffer<uint32_t> Region::edges() const { return marked(has_edge); }

Buffer<uint32_t> shared_half_edges(const Topology& mesh) {
  Buffer<uint32_t> shared;
  if (std::ranges::find(mesh.kind, EdgeKind::shared) == mesh.kind.end()) return shared;
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.kind[mesh.edge[h]] == EdgeKind::shared) shared.push_back(h);
  return shared;
}

}  // namespace papilio
