#pragma once

#include "hierarchy/level_choice.h"
#include "split/split_pattern.h"

// Transition faces: the pieces of a face of a red-green level with one or two split edges.

namespace papilio {

/// Returns the upper bound of the cosine of a transition face's smallest angle, given the smallest angle (radians) of
/// the coarse mesh.
[[nodiscard]] double most_cosine_beside(double smallest_angle);

/// Judgement of a face with one or two split edges, `mask` (bit i: edge i).
class Transition {
 public:
  enum : uint32_t { second_diagonal = 1, has_sliver = 2 };

  /// Packs the judgement and its mask, as stored in `LevelChoice::transitions`.
  [[nodiscard]] static uint8_t with_mask(uint32_t bits, unsigned mask) { return static_cast<uint8_t>(4 * mask | bits); }
  /// Returns the judgement for this mask, computed if it is not stored.
  [[nodiscard]] static uint32_t find(const LevelChoice& choice, FaceId face, unsigned mask) {
    const uint32_t noted = choice.transitions.empty() ? 0 : choice.transitions[face];
    return noted / 4 == mask ? noted % 4 : judge(*choice.level, face, mask);
  }

 private:
  [[nodiscard]] static uint32_t judge(const HierarchyLevel& level, FaceId face, unsigned mask);
};

/// Returns whether a face with two split edges takes the second diagonal (split_pattern()): the one whose smallest
/// angle is larger, or on a tie, the one from the lower-numbered corner. False with one split edge.
[[nodiscard]] inline bool takes_second_diagonal(const LevelChoice& choice, FaceId face, unsigned mask) {
  return (Transition::find(choice, face, mask) & Transition::second_diagonal) != 0;
}

/// Returns the smallest angle of the mesh's faces, in radians; 0 if one has no area.
[[nodiscard]] double smallest_angle(const Mesh& mesh);

/// Divides faces with slivers among their pieces until none is left. A sliver's smallest angle has a cosine above the
/// level's `most_cosine`; faces that exceed it themselves are exempt. Splits only edges of the choice's region.
void avoid_slivers(LevelChoice& choice);

}  // namespace papilio
