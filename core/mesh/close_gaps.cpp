#include "mesh/close_gaps.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "mesh/divide_faces.h"
#include "mesh/t_junctions.h"
#include "mesh/weld_gaps.h"

namespace papilio {
namespace {

constexpr int most_attempts = 4;

/// Returns the draft with its gaps welded; nothing if it has no gaps.
std::optional<Draft> welded(const Draft& draft, double distance) {
  const Buffer<uint32_t> vertex = weld_gaps(draft.topology, draft.positions, distance);
  if (vertex.empty()) return std::nullopt;
  Draft welded = draft;
  for (VertexId v = 0; v < vertex.size(); ++v) welded.report.near_duplicates += vertex[v] == v ? 0 : 1;
  for (uint32_t& v : welded.topology.origin) v = vertex[v];
  for (uint32_t& v : welded.tracked) v = vertex[v];
  settle(welded);
  return welded;
}

/// Returns [V] whether a vertex has several fans or lies on an edge that several faces share.
std::vector<bool> defective_vertices(const Topology& mesh) {
  std::vector<bool> is_defective(mesh.vertex_count);
  for (const VertexId v : mesh.pinched) is_defective[v] = true;
  for (const HalfEdgeId h : mesh.half_edge)
    if (mesh.kind[mesh.edge[h]] == EdgeKind::shared) is_defective[mesh.origin[h]] = is_defective[mesh.tip(h)] = true;
  return is_defective;
}

/// Removes the insertions of vertices that are defective in the closed draft. Returns whether there are any.
bool drop_defective(std::vector<Insertion>& insertions, const Draft& closed) {
  const std::vector<bool> is_defective = defective_vertices(closed.topology);
  size_t kept = 0;
  for (size_t i = 0; i < insertions.size(); ++i)
    if (!is_defective[closed.tracked[i]]) insertions[kept++] = insertions[i];
  const bool drops = kept < insertions.size();
  insertions.resize(kept);
  return drops;
}

void close_t_junctions(Draft& draft, BlendedPoints& points, double distance) {
  std::vector<Insertion> insertions = find_t_junctions(draft.topology, draft.positions, distance);
  if (draft.topology.face_count() + insertions.size() > face_count_limit) return;
  for (int attempt = 0; attempt < most_attempts && !insertions.empty(); ++attempt) {
    Draft closed = divide_faces(draft, insertions, points);
    if (std::optional<Draft> both = welded(closed, distance)) closed = std::move(*both);
    if (!is_worse(closed.report, draft.report)) {
      if (closed.report.boundary_edges < draft.report.boundary_edges) draft = std::move(closed);
      return;
    }
    if (!drop_defective(insertions, closed)) return;
  }
}

}  // namespace

void close_gaps(Draft& draft, BlendedPoints& points, double distance) {
  if (draft.report.boundary_edges == 0 || !(distance > 0)) return;
  std::optional<Draft> closed = welded(draft, distance);
  if (closed && !is_worse(closed->report, draft.report)) draft = std::move(*closed);
  if (draft.report.boundary_edges > 0) close_t_junctions(draft, points, distance);
}

}  // namespace papilio
