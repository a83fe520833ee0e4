#include "hierarchy/move_bounds.h"
#include "simd/extremes.h"

#include <algorithm>
#include <cmath>

#include "criteria/deviation.h"
#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

/// Returns whether the face's children are in the result in its place.
bool is_divided(const LevelChoice& choice, FaceId face) { return choice.split_mask(face) == 7; }

bool is_at_middle(const Mesh& mesh, EdgeId edge, double offset) {
  constexpr double rounding = 1e-6;
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  const Vec3d along =
      to_double(mesh.positions[mesh.topology.tip(h)]) - to_double(mesh.positions[mesh.topology.origin[h]]);
  return offset * offset <= rounding * rounding * dot(along, along);
}

/// Returns an estimate of the moves at further levels of a smooth edge that does not move now. Between curves or
/// corners an edge has no rule (the published one is its middle), but its halves have.
double move_to_come(const LevelChoice& choice, EdgeId edge) {
  constexpr double share_of_bend = 1.0 / 8;  // the rule's weight of what lies beside
  const Topology& mesh = choice.level->mesh.topology;
  const HalfEdgeId h = mesh.half_edge[edge];
  const Buffer<Vec3f>& normals = choice.level->trial.normals;
  const Vec3d turn = to_double(normals[h.face()]) - to_double(normals[Topology::face(mesh.twin[h])]);
  const Buffer<Vec3f>& at = choice.level->mesh.positions;
  return share_of_bend * length(turn) * length(to_double(at[mesh.tip(h)]) - to_double(at[mesh.origin[h]]));
}

}  // namespace

double move_bound(const LevelChoice& choice, EdgeId edge, double enough) {
  const HierarchyLevel& level = *choice.level;
  const Topology& mesh = level.mesh.topology;
  const HalfEdgeId h = mesh.half_edge[edge];
  const double offset = std::sqrt(level.trial.squared_offset(level.mesh, edge));
  if (mesh.kind[edge] != EdgeKind::smooth) return offset;
  if (offset <= enough)
    return is_at_middle(level.mesh, edge, offset) ? larger(offset, move_to_come(choice, edge)) : offset;
  // A vertex that slides along one side of a bend leaves the edge uncovered.
  const Buffer<Vec3f>& normals = level.trial.normals;
  const double cosine = dot(normals[h.face()], normals[Topology::face(mesh.twin[h])]);
  const double sine = cosine > 0 ? std::sqrt(larger(0.0, 1 - cosine * cosine)) : 1;
  return lesser(offset, level.trial.deviation_at(level.mesh, edge) + sine * offset);
}

double squared_move(const Mesh& whole, HalfEdgeId h, Vec3d made) {
  const Topology& mesh = whole.topology;
  const auto at = [&](VertexId v) { return to_double(whole.positions[v]); };
  const Vec3d a = at(mesh.origin[h]);
  const Vec3d b = at(mesh.tip(h));
  const Vec3d middle = 0.5 * (a + b);
  double before = dot(made - middle, made - middle);
  double after = before;
  const auto add_face = [&](uint32_t half_edge) {
    const Vec3d apex = at(mesh.apex(half_edge));
    before = lesser(before, squared_distance(made, {a, b, apex}));
    after = lesser(after, squared_distance(middle, {a, made, apex}), squared_distance(middle, {made, b, apex}));
  };
  add_face(h);
  if (mesh.twin[h] != none) add_face(mesh.twin[h]);
  return larger(before, after);
}

Buffer<float> largest_moves(const LevelChoice& choice, double enough) {
  const Topology& mesh = choice.level->mesh.topology;
  auto at_edge = Buffer<float>::for_overwrite(mesh.edge_count());
  for (EdgeId e = 0; e < mesh.edge_count(); ++e)
    at_edge[e] = choice.region.has_edge[e] != 0 ? static_cast<float>(move_bound(choice, e, enough)) : 0;
  Buffer<float> moves(mesh.face_count(), 0);
  for (FaceId f : choice.region.faces) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    moves[f] = larger(at_edge[edge[0]], at_edge[edge[1]], at_edge[edge[2]]);
  }
  return moves;
}

Buffer<float> sums_above(const LevelChoice& above, const Buffer<float>& sums, const Buffer<float>& moves,
                         const LevelChoice& below) {
  Buffer<float> all(below.level->mesh.topology.face_count(), 0);
  for (size_t i = 0; i < below.region.faces.size(); i += 4) {
    const FaceId f = below.region.faces[i];
    const uint32_t parent = below.level->parent_of(f);
    if (!is_divided(above, parent)) std::fill_n(&all[f], 4, sums[parent] + moves[parent]);
  }
  return all;
}

Buffer<uint8_t> vertices_that_may_leave(const LevelChoice& choice, const Buffer<float>& sums,
                                        const Buffer<float>& moves, const Buffer<float>& allowed) {
  constexpr float share_that_counts = 0.5F;
  const Topology& mesh = choice.level->mesh.topology;
  Buffer<float> further(mesh.vertex_count, 0);  // the largest move at the vertex
  float known = 0;                              // share
  for (FaceId f : choice.region.faces) {
    if (!is_divided(choice, f) && sums[f] + moves[f] > 0) known = larger(known, (sums[f] + moves[f]) / allowed[f]);
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) further[mesh.origin[h]] = larger(further[mesh.origin[h]], moves[f]);
  }
  // On smooth surfaces further levels add a third of the last move. If every distance is below the allowed one, the
  // largest is stated, and less smooth surfaces add more.
  const float share_of_rest = known < 1 ? 1 : 0.5F;
  Buffer<uint8_t> marks(mesh.vertex_count, 0);
  for (FaceId f : choice.region.faces) {
    const uint32_t* corner = &mesh.origin[size_t{3} * f];
    const float matters = known < 1 ? known * allowed[f] : allowed[f];  // not a number where anything is allowed
    const float more = share_of_rest * larger(further[corner[0]], further[corner[1]], further[corner[2]]);
    const bool is_open = moves[f] + more > share_that_counts * matters && sums[f] + moves[f] + more > matters;
    if (is_divided(choice, f) || is_open)
      for (uint32_t i = 0; i < 3; ++i) marks[corner[i]] = 1;
  }
  return marks;
}

std::vector<Buffer<float>> sums_below(std::span<const LevelChoice> levels, int level_count, double enough) {
  constexpr float share_of_rest = 0.5;
  std::vector<Buffer<float>> sums(levels.size());
  for (size_t k = levels.size(); k-- > 0;) {
    const LevelChoice& choice = levels[k];
    sums[k] = largest_moves(choice, enough);
    const bool has_rest = static_cast<int>(k) + 1 < level_count;
    for (FaceId f : choice.region.faces) {
      if (k + 1 < levels.size() && choice.red[f] != 0) {
        const float* child = &sums[k + 1][levels[k + 1].level->first_child_of(f)];
        sums[k][f] += larger(child[0], child[1], child[2], child[3]);
      } else if (has_rest) {
        sums[k][f] *= 1 + share_of_rest;
      }
    }
  }
  return sums;
}

}  // namespace papilio
