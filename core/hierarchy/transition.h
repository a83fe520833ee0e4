#pragma once

#include "hierarchy/level_choice.h"
#include "split/split_pattern.h"

// Transition faces: the pieces of a face of a red-green level with one or two split edges.

namespace papilio {

/// Returns the upper bound of the cosine of a transition face's smallest angle, given the smallest angle (radians) of
/// the coarse mesh. It is equal for all levels of a hierarchy.
[[nodiscard]] double most_cosine_beside(double smallest_angle);

/// Judgement of a face with one or two split edges, `mask` (bit i: edge i).
struct Transition {
  enum : uint32_t { is_judged = 1, second_diagonal = 2, has_sliver = 4 };

  /// Packs the judgement and its mask, as stored in `LevelChoice::transitions`.
  [[nodiscard]] static uint8_t with_mask(uint32_t bits, unsigned mask) { return static_cast<uint8_t>(8 * mask | bits); }
  /// Returns the stored judgement for this mask; 0 if there is none.
  [[nodiscard]] static uint32_t known(const LevelChoice& choice, FaceId face, unsigned mask) {
    const uint32_t noted = choice.transitions.empty() ? 0 : choice.transitions[face];
    return noted / 8 == mask ? noted % 8 : 0;
  }
  /// Returns the judgement for this mask, computed if it is not stored.
  [[nodiscard]] static uint32_t find(const LevelChoice& choice, FaceId face, unsigned mask, double most_cosine);
};

/// Returns whether a face with two split edges takes the second diagonal (split_pattern()): the one whose smallest
/// angle is larger, or on a tie, the one from the lower-numbered corner. False with one split edge.
[[nodiscard]] inline bool takes_second_diagonal(const LevelChoice& choice, FaceId face, unsigned mask,
                                                double most_cosine) {
  uint32_t bits = Transition::known(choice, face, mask);
  if (bits == 0) [[unlikely]]
    bits = Transition::find(choice, face, mask, most_cosine);
  return (bits & Transition::second_diagonal) != 0;
}

/// Returns the smallest angle of the mesh's faces, in radians; 0 if one has no area.
[[nodiscard]] double smallest_angle(const Mesh& mesh);

/// Divides faces with slivers among their pieces until none is left. A sliver's smallest angle has a cosine above
/// `most_cosine`; faces that exceed it themselves are exempt. Splits only edges of the choice's region.
void avoid_slivers(LevelChoice& choice, double most_cosine);

}  // namespace papilio
