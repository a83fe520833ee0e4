#pragma once

#include <optional>
#include <vector>

#include "criteria/selection.h"
#include "hierarchy/allowed_distance.h"
#include "hierarchy/level_choice.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/progress.h"

namespace papilio {

/// Search, level by level, for the faces below which the next level is needed. For criteria by error.
class Exploration {
 public:
  /// All must outlive this.
  Exploration(const Options& options, const Selection& selection, const MemoryPlan& plan, const Progress& progress)
      : options_(options), selection_(selection), plan_(plan), progress_(progress) {}

  /// Returns faces of the lowest level; call it once a level. A face is returned if it touches a face with an edge of
  /// at least this error, or a face below which the distance from the surface may exceed `limit`, unless its edges must
  /// not be split. (Half of that error, and a tenth, gave the same results.) In a mesh with detail, faces with moves of
  /// finer levels below are returned too: with a limit, every visible face. In a mechanical mesh also their neighbours:
  /// an edge in a flat may bend a level later, once the faces beside it have.
  [[nodiscard]] Buffer<uint32_t> faces_to_look_into(const std::vector<LevelChoice>& choices, float error,
                                                    const std::optional<DistanceLimit>& limit);

 private:
  [[nodiscard]] Buffer<uint8_t> vertices_that_may_leave(const std::vector<LevelChoice>& choices,
                                                        const DistanceLimit& limit);
  [[nodiscard]] bool may_have_detail_below(const LevelChoice& choice, FaceId face, float error) const;

  const Options& options_;
  const Selection& selection_;
  const MemoryPlan& plan_;
  const Progress& progress_;
  Buffer<float> sums_above_, moves_, allowed_;  ///< [F] of the lowest level (move_bounds.h, allowed_distance.h)
  double move_below_ = 0;                       ///< the largest of the detail below it
};

}  // namespace papilio
