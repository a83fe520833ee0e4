#pragma once

#include "hierarchy/level_choice.h"
#include "split/split_pattern.h"

// Transition faces: the pieces into which one or two split edges cut a face of a red-green level.

namespace papilio {

/// What a transition face's smallest angle is held against: the cosine that none should exceed, given the smallest
/// angle (radians) of the coarse mesh. One for all of a hierarchy.
[[nodiscard]] double most_cosine_beside(double smallest_angle);

/// What is found out about a face with the split edges of `mask` (bit i: edge i): one or two.
struct Transition {
  enum : uint32_t { is_known = 1, second_diagonal = 2, has_sliver = 4 };

  /// As LevelChoice::transitions has it.
  [[nodiscard]] static uint8_t with_mask(uint32_t bits, unsigned mask) { return static_cast<uint8_t>(8 * mask | bits); }
  /// The bits noted there for this mask; 0 where there are none.
  [[nodiscard]] static uint32_t known(const LevelChoice& choice, uint32_t face, unsigned mask) {
    const uint32_t noted = choice.transitions.empty() ? 0 : choice.transitions[face];
    return noted / 8 == mask ? noted % 8 : 0;
  }
  /// The same, found where it is not known.
  [[nodiscard]] static uint32_t find(const LevelChoice& choice, uint32_t face, unsigned mask, double most_cosine);
};

/// Whether such a face is cut by the second diagonal (split_pattern()): of the two ways to cut a quadrangle, the one
/// whose smallest angle is larger; where they are equal, the diagonal from the lower corner. False with one split edge.
[[nodiscard]] inline bool takes_second_diagonal(const LevelChoice& choice, uint32_t face, unsigned mask,
                                                double most_cosine) {
  uint32_t bits = Transition::known(choice, face, mask);
  if (bits == 0) [[unlikely]]
    bits = Transition::find(choice, face, mask, most_cosine);
  return (bits & Transition::second_diagonal) != 0;
}

/// The smallest angle of the mesh's faces, in radians; 0 for one without area.
[[nodiscard]] double smallest_angle(const Mesh& mesh);

/// Has the other edges of a face split too where pieces would have an angle of a larger cosine though the face itself
/// has not, until no such face is left. Adds to `choice.split`, edges of its region only.
void avoid_slivers(LevelChoice& choice, double most_cosine);

}  // namespace papilio
