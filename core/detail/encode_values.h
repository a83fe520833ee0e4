#pragma once

#include <functional>
#include <span>
#include <vector>

#include "detail/base_lift.h"
#include "detail/collapse_sequence.h"
#include "detail/encode_pieces.h"
#include "detail/original_surface.h"
#include "papilio/detail.h"

namespace papilio {

/// Encodes the texture coordinates and colours of the levels of a base whose positions are chosen: those that the
/// original has where the vertices came to lie, in the charts that they correspond to. `positions`: vertices of the
/// base and of all levels. `lifted` must have either. `step`: of the last level; coarser ones have smaller ones. In so
/// many pieces a level.
[[nodiscard]] std::vector<CodedValues> encode_values(const OriginalSurface& original, const LiftedBase& lifted,
                                                     const CollapseSequence& sequence, const BaseMesh& base,
                                                     const Buffer<Vec3f>& positions, float step,
                                                     const PieceOrder& order, std::span<const uint32_t> piece_counts,
                                                     const std::function<void()>& poll);

}  // namespace papilio
