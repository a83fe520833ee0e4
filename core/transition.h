#pragma once

#include "level_choice.h"
#include "split_pattern.h"

// Transition faces: the pieces into which one or two split edges cut a face of a red-green level.

namespace papilio {

/// What a transition face's smallest angle is held against: the cosine that none should exceed, given the smallest
/// angle (radians) of the coarse mesh. One for all of a hierarchy.
[[nodiscard]] double most_cosine_beside(double smallest_angle);

/// The pattern for the face with the split edges of `mask` (bit i: edge i): of the two ways to cut a quadrangle, the
/// one whose smallest angle is larger; where they are equal, the diagonal from the lower corner. Returned as a pattern
/// number = 2 * mask + (second diagonal ? 1 : 0).
[[nodiscard]] uint8_t choose_transition(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine);
[[nodiscard]] inline const SplitPattern& transition_pattern(uint8_t number) { return split_patterns[number]; }

/// The smallest angle of the mesh's faces, in radians; 0 for one without area.
[[nodiscard]] double smallest_angle(const Mesh& mesh);

/// Has the other edges of a face split too where pieces would have an angle of a larger cosine though the face itself
/// has not, until no such face is left. Adds to `choice.split`, edges of its region only.
void avoid_slivers(LevelChoice& choice, double most_cosine);

}  // namespace papilio
