#include "hierarchy/exploration.h"

#include <algorithm>

#include "hierarchy/detail_levels.h"
#include "hierarchy/move_bounds.h"

namespace papilio {

Buffer<uint32_t> Exploration::faces_to_look_into(const std::vector<LevelChoice>& choices, float error,
                                                 const std::optional<DistanceLimit>& limit) {
  const LevelChoice& choice = choices.back();
  const Topology& mesh = choice.level->mesh.topology;
  auto touched = limit ? vertices_that_may_leave(choices, *limit) : Buffer<uint8_t>(mesh.vertex_count, 0);
  const auto touch = [&](FaceId f) {
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) touched[mesh.origin[h]] = 1;
  };
  for (FaceId f : choice.region.faces) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    if (std::max({choice.error[edge[0]], choice.error[edge[1]], choice.error[edge[2]]}) >= error) touch(f);
  }
  if (choice.level->detail_levels > 1) {
    if (!limit)
      move_below_ =
          largest_move_below(choices[0].level->mesh, static_cast<int>(choices.size()), options_, plan_, progress_);
    for (FaceId f : choice.region.faces)
      if (limit ? allowed_[f] < AllowedDistance::any : choice.may_divide(f) && may_have_detail_below(choice, f, error))
        touch(f);
  }
  const auto is_near = [&](FaceId f) { return is_touched(mesh, touched, f); };
  if (mesh.shape.is_mechanical)
    for (FaceId f : chosen(choice.region.faces, is_near)) touch(f);
  return chosen(choice.region.faces, [&](FaceId f) {
    const bool may_divide = choice.may_divide(f);
    return is_near(f) & may_divide;
  });
}

Buffer<uint8_t> Exploration::vertices_that_may_leave(const std::vector<LevelChoice>& choices,
                                                     const DistanceLimit& limit) {
  constexpr float share_known = 1.0F / 64;
  const LevelChoice& choice = choices.back();
  const size_t k = choices.size() - 1;
  sums_above_ = k == 0 ? Buffer<float>(choice.level->mesh.topology.face_count(), 0)
                       : sums_above(choices[k - 1], sums_above_, moves_, choice);
  allowed_ = limit.at_faces(choice);
  auto least = static_cast<float>(AllowedDistance::any);
  for (FaceId f : choice.region.faces) least = std::min(least, allowed_[f]);
  moves_ = largest_moves(choice, share_known * least);
  return papilio::vertices_that_may_leave(choice, sums_above_, moves_, allowed_);
}

/// Returns whether the detail may have a move of large error below a face. The moves of a level do not bound those of
/// the next one.
bool Exploration::may_have_detail_below(const LevelChoice& choice, FaceId face, float error) const {
  const HierarchyLevel& level = *choice.level;
  const uint32_t* edge = &level.mesh.topology.edge[size_t{3} * face];
  return std::any_of(edge, edge + 3, [&](EdgeId e) {
    return choice.shown[e] && selection_.error_of(level.mesh, level.trial, e, move_below_) >= error;
  });
}

}  // namespace papilio
