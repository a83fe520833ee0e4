#pragma once

#include <span>

#include "criteria/selection.h"
#include "hierarchy/level_choice.h"

namespace papilio {

/// Finds the faces at the outline of what a view shows that are not divided, though the outline of the levels below may
/// run through them: they touch a vertex at which one edge is wanted, as its halves may be, and another is not shown;
/// they may be divided, and the view keeps an edge of theirs from being split. Notes them in the choice, and adds them
/// to the faces that are to have children. Both are in ascending order.
void add_faces_at_outline(LevelChoice& choice, const Selection& selection, Buffer<uint32_t>& red);

/// Divides the faces at outlines below which something is split, from the lowest level up, and what that needs so that
/// no transition face becomes a sliver (transition.h).
void divide_at_outlines(std::span<LevelChoice> levels, double most_cosine);

}  // namespace papilio
