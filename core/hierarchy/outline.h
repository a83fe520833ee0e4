#pragma once

#include <span>

#include "criteria/selection.h"
#include "hierarchy/level_choice.h"

namespace papilio {

/// Finds undivided faces through which the view's outline on the levels below may run. All of these hold:
/// - the face has a vertex at a candidate edge whose halves may be candidates, and at an edge that is not shown;
/// - flatness selects all its edges;
/// - the view prevents the split of at least one.
/// Stores them in `LevelChoice::at_outline` and adds them to `red`, the faces that get children; both in ascending
/// order. `level` is the number of the level below.
void add_faces_at_outline(LevelChoice& choice, int level, const Selection& selection, Buffer<uint32_t>& red);

/// Divides the faces at outlines below which an edge is split, from the lowest level up, and further faces to avoid
/// slivers (transition.h).
void divide_at_outlines(std::span<LevelChoice> levels);

}  // namespace papilio
