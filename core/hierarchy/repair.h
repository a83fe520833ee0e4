#pragma once

#include <vector>

#include "hierarchy/level_choice.h"
#include "hierarchy/surface_check.h"

namespace papilio {

/// Split edges of all levels.
using Splits = std::vector<Buffer<uint32_t>>;
[[nodiscard]] Splits splits_of(const std::vector<LevelChoice>& choices);
/// Replaces the split edges of the levels; levels beyond the last of `splits` get none.
void set_splits(std::vector<LevelChoice>& choices, const Splits& splits);

/// Search for further edges to split until the result is within a distance of the uniform surface. Choosing edges by
/// their own moves gives the smallest mean error; about one vertex in a hundred is then too far away, and is found by
/// comparing the surfaces.
class Repair {
 public:
  /// `choices` must outlive this object, and not grow. Edges with an error of at least `threshold` are already
  /// candidates. `progress`: see surface_check.h.
  Repair(std::vector<LevelChoice>& choices, float threshold, AllowedDistance allowed, int level_count,
         const Progress& progress);

  /// Adds candidates of the largest possible error: at each face too far away the edges at which the surface moves
  /// most. Returns false if there are none.
  bool add_candidates();
  /// Returns whether the last call of add_candidates() found all faces near enough.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// Returns whether any distance exceeds a share of the allowed one.
  [[nodiscard]] bool exceeds(double share) const { return check_.exceeds(share); }
  /// Discards the findings at faces whose surroundings changed; call it when the candidates have been split.
  void look_again();

 private:
  bool add_candidates(const LevelFace& face);

  std::vector<LevelChoice>& choices_;
  float threshold_;
  SurfaceCheck check_;
  NearFaces near_;
  Splits before_;  ///< at the last comparison
  bool is_complete_ = false;
};

}  // namespace papilio
