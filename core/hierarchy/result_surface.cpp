#include "hierarchy/result_surface.h"

#include <algorithm>

#include "hierarchy/transition.h"
#include "split/split_pattern.h"

namespace papilio {
namespace {

constexpr size_t most_visited = 64;

}  // namespace

Corners corners_of(const LevelChoice& choice, FaceId face) {
  const Mesh& mesh = choice.level->mesh;
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * face];
  return {to_double(mesh.positions[corner[0]]), to_double(mesh.positions[corner[1]]),
          to_double(mesh.positions[corner[2]])};
}

Corners new_vertices_of(const LevelChoice& choice, FaceId face, const Corners& corner) {
  Corners made;
  for (uint32_t i = 0; i < 3; ++i) {
    const EdgeId e = choice.level->mesh.topology.edge[3 * face + i];
    made[i] =
        choice.region.has_edge[e] != 0 ? to_double(choice.level->trial.at(e)) : 0.5 * (corner[i] + corner[(i + 1) % 3]);
  }
  return made;
}

bool ResultSurface::has_second_diagonal(uint32_t k, FaceId f, unsigned mask) const {
  return takes_second_diagonal(choice(k), f, mask);
}

void ResultSurface::find_pieces(const LevelFace& leaf, std::vector<TriangleCorners>& pieces) const {
  const auto [k, f] = leaf;
  pieces.clear();
  const Corners corner = corners(k, f);
  const unsigned mask = choice(k).split_mask(f);
  const Corners made = mask != 0 ? new_vertices(k, f, corner) : corner;
  const SplitPattern& cut = split_pattern(mask, has_two_targets(mask) && has_second_diagonal(k, f, mask));
  const auto at = [&](uint8_t local) { return local < 3 ? corner[local] : made[local - 3U]; };
  for (uint32_t c = 0; c < cut.children; ++c)
    pieces.push_back({at(cut.corner[c][0]), at(cut.corner[c][1]), at(cut.corner[c][2])});
}

void ResultSurface::find_beside(const LevelFace& leaf, uint32_t i, std::vector<LevelFace>& beside) const {
  beside.clear();
  if (topology(leaf.level).twin[3 * leaf.face + i] == none) return;
  const auto [k, other] = face_across(leaf.level, leaf.face, i);
  if (k > 0 && !is_divided(k - 1, level(k).parent_of(other))) {
    beside.push_back({k - 1, level(k).parent_of(other)});
  } else if (!is_divided(k, other)) {
    beside.push_back({k, other});
  } else {
    for (uint32_t child = first_child(k, other); child < first_child(k, other) + 4; ++child)
      if (!is_divided(k + 1, child)) beside.push_back({k + 1, child});
  }
}

LevelFace ResultSurface::face_across(uint32_t k, FaceId f, uint32_t i) const {
  const uint32_t other = Topology::face(topology(k).twin[3 * f + i]);
  if (k == 0 || level(k).parent_of(other) != none) return {k, other};
  // A last level may hold children of red faces alone (refine_last_level). The side is half of one of the face above.
  const uint32_t parent = level(k).parent_of(f);
  const uint32_t half_edge = 3 * (f - level(k).first_child_of(parent)) + i;
  const auto& outer = split_pattern(7, false).outer;
  const auto side = static_cast<uint32_t>(std::ranges::find(outer, half_edge) - outer.begin()) / 2;
  return {k - 1, Topology::face(topology(k - 1).twin[3 * parent + side])};
}

double ResultSurface::squared_distance_to_leaf(const LevelFace& leaf, Vec3d point, double enough,
                                               TriangleCorners& nearest) {
  find_pieces(leaf, pieces_);
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleCorners& piece : pieces_) {
    const double distance = squared_distance(point, piece);
    if (distance >= least) continue;
    least = distance;
    nearest = piece;
    if (least <= enough) break;
  }
  return least;
}

double ResultSurface::squared_distance_from(const LevelFace& leaf, Vec3d point, double enough,
                                            TriangleCorners* nearest) {
  TriangleCorners nearest_of_leaf{};
  visited_.assign(1, leaf);
  double least = std::numeric_limits<double>::infinity();
  const auto visit = [&](const LevelFace& visited) {
    const double distance = squared_distance_to_leaf(visited, point, enough, nearest_of_leaf);
    if (distance > least) return false;
    least = distance;
    if (nearest != nullptr) *nearest = nearest_of_leaf;
    return true;
  };
  visit(leaf);
  for (size_t at = 0; at < visited_.size() && least > enough; ++at)
    for (uint32_t i = 0; i < 3; ++i) {
      find_beside(visited_[at], i, beside_);
      for (const LevelFace& beside : beside_) {
        if (visited_.size() == most_visited || std::ranges::count(visited_, beside) > 0 || !visit(beside)) continue;
        if (least <= enough) return least;
        visited_.push_back(beside);
      }
    }
  return least;
}

}  // namespace papilio
