#pragma once

#include <vector>

#include "hierarchy/level_choice.h"
#include "hierarchy/surface_check.h"

namespace papilio {

/// The splits of all levels.
using Splits = std::vector<Buffer<uint32_t>>;
[[nodiscard]] Splits splits_of(const std::vector<LevelChoice>& choices);
/// Replaces the splits of the levels; none in those behind the last.
void set_splits(std::vector<LevelChoice>& choices, const Splits& splits);

/// Finds which edges must be split besides, so that a result keeps within a distance of the uniform surface. Edges are
/// chosen by the largest single move first, which gives the smallest mean error; only about one vertex in a hundred is
/// then too far away, and is found by comparing the surfaces.
class Repair {
 public:
  /// `choices` must outlive this, and not grow. Edges with an error of at least `threshold` are candidates already.
  /// `progress`: see surface_check.h.
  Repair(std::vector<LevelChoice>& choices, float threshold, double most_cosine, AllowedDistance allowed,
         int level_count, const Progress& progress);

  /// Makes candidates with the largest of all errors of those edges of the faces too far away at which the surface
  /// moves most. Returns false if there are none.
  bool add_candidates();
  /// Whether the last call of add_candidates() found all faces near enough.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// To be called when the candidates have been split.
  void look_again();

 private:
  bool add_candidates(const LevelFace& face);

  std::vector<LevelChoice>& choices_;
  float threshold_;
  SurfaceCheck check_;
  NearFaces near_;
  Splits before_;  ///< when the faces were last compared
  bool is_complete_ = false;
};

}  // namespace papilio
