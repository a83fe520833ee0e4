#include "mesh/draft.h"

#include <utility>

#include "mesh/connect.h"

namespace papilio {

void connect(Draft& draft) {
  Topology& topology = draft.topology;
  topology.vertex_count = static_cast<uint32_t>(draft.positions.size());
  const uint32_t repeated = std::exchange(draft.report.repeated_faces, 0);
  draft.report.boundary_edges = draft.report.non_manifold_edges = draft.report.misoriented_edges = 0;
  connect(topology, draft.corner_point, draft.report);
  draft.report.repeated_faces += repeated;
  topology.pinched = find_pinched(topology);
  draft.report.pinched_vertices = static_cast<uint32_t>(topology.pinched.size());
}

void settle(Draft& draft) {
  Buffer<uint32_t> number(draft.positions.size(), none);
  Buffer<Vec3f> positions;
  positions.reserve(draft.positions.size());
  for (uint32_t& vertex : draft.topology.origin) {
    if (number[vertex] == none) {
      number[vertex] = static_cast<uint32_t>(positions.size());
      positions.push_back(draft.positions[vertex]);
    }
    vertex = number[vertex];
  }
  draft.positions = std::move(positions);
  for (uint32_t& vertex : draft.tracked) vertex = number[vertex];
  for (Buffer<uint32_t>* of_edges : {&draft.topology.twin, &draft.topology.edge, &draft.topology.half_edge})
    of_edges->clear();
  draft.topology.kind.clear();
  connect(draft);
}

bool is_worse(const BuildReport& report, const BuildReport& than) {
  return report.non_manifold_edges > than.non_manifold_edges || report.misoriented_edges > than.misoriented_edges ||
         report.pinched_vertices > than.pinched_vertices || report.degenerate_faces > than.degenerate_faces ||
         report.repeated_faces > than.repeated_faces;
}

}  // namespace papilio
