#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio::test {

/// Artefacts of a refinement. Distances are shares of the coarse mesh's diagonal.
struct Harm {
  uint32_t folds =
      0;  ///< edges at which the surface turns by over 120 degrees, less those that are parts of coarse ones
  double overshoot = 0;  ///< largest distance of the surface outside the coarse mesh's box
  double distance = 0;   ///< root mean square distance of the middles of its faces from the coarse surface
};

/// Returns the edges at which the surface turns by over 120 degrees.
[[nodiscard]] uint32_t count_folds(const Mesh& mesh);

/// Measures `fine`, which is `coarse` after a number of uniform levels.
[[nodiscard]] Harm harm_of(const Mesh& coarse, const Mesh& fine, int levels);

/// Returns the area-weighted root mean square distance of the first mesh's face centres from the second's surface, as a
/// share of the second's diagonal.
[[nodiscard]] double rms_distance(const Mesh& from, const Mesh& to);

}  // namespace papilio::test
