#include "mesh/close_gaps.h"

#include <optional>
#include <utility>

#include "mesh/weld_gaps.h"

namespace papilio {
namespace {

/// Returns a draft with its gaps welded; nothing if it has none.
std::optional<Draft> welded(const Draft& draft, double distance) {
  const Buffer<uint32_t> vertex = weld_gaps(draft.topology, draft.positions, distance);
  if (vertex.empty()) return std::nullopt;
  Draft welded = draft;
  for (uint32_t v = 0; v < vertex.size(); ++v) welded.report.near_duplicates += vertex[v] == v ? 0 : 1;
  for (uint32_t& v : welded.topology.origin) v = vertex[v];
  settle(welded);
  return welded;
}

}  // namespace

void close_gaps(Draft& draft, double distance) {
  if (draft.report.boundary_edges == 0 || !(distance > 0)) return;
  std::optional<Draft> closed = welded(draft, distance);
  if (closed && !is_worse(closed->report, draft.report)) draft = std::move(*closed);
}

}  // namespace papilio
