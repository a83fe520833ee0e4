#pragma once

#include <optional>
#include <vector>

#include "criteria/selection.h"
#include "hierarchy/allowed_distance.h"
#include "hierarchy/level_choice.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/progress.h"

namespace papilio {

/// Where errors decide, finds level by level below which faces further ones must be known.
class Exploration {
 public:
  /// All must outlive this.
  Exploration(const Options& options, const Selection& selection, const MemoryPlan& plan, const Progress& progress)
      : options_(options), selection_(selection), plan_(plan), progress_(progress) {}

  /// Faces of the lowest level, to be called once for each: every one that touches one with an edge of at least this
  /// error, or one below which the result may be further from the surface than `limit`, unless its edges may not be
  /// split. (Edges of half that error were tried too, and a tenth: results were the same.) Of a mesh with detail also
  /// every face below which a move of its finer levels may be: where there is a limit these are all that the view
  /// shows. In a mechanical mesh an edge that stays in a flat may bend a level further, once the faces beside it have:
  /// there their neighbours are looked into, too.
  [[nodiscard]] Buffer<uint32_t> faces_to_look_into(const std::vector<LevelChoice>& choices, float error,
                                                    const std::optional<DistanceLimit>& limit);

 private:
  [[nodiscard]] Buffer<uint8_t> vertices_that_may_leave(const std::vector<LevelChoice>& choices,
                                                        const DistanceLimit& limit);
  [[nodiscard]] bool may_have_detail_below(const LevelChoice& choice, uint32_t face, float error) const;

  const Options& options_;
  const Selection& selection_;
  const MemoryPlan& plan_;
  const Progress& progress_;
  Buffer<float> sums_above_, moves_, allowed_;  ///< [F] of the lowest level (move_bounds.h, allowed_distance.h)
  double move_below_ = 0;                       ///< the largest of the detail below it
};

}  // namespace papilio
