#pragma once

#include <span>
#include <vector>

#include "base/poller.h"
#include "detail/base_lift.h"
#include "detail/collapse_sequence.h"
#include "detail/encode_pieces.h"
#include "detail/original_surface.h"
#include "papilio/detail.h"

namespace papilio {

/// Encodes the texture coordinates and colours of a base's levels, once positions are chosen: the original's values at
/// the vertices, in the corresponding charts. `positions`: vertices of the base and of all levels. `lifted` must have
/// either attribute. `step`: step of the last level; coarser levels have smaller steps. `piece_counts` [level]
[[nodiscard]] std::vector<CodedValues> encode_values(const OriginalSurface& original, const LiftedBase& lifted,
                                                     const CollapseSequence& sequence, const BaseMesh& base,
                                                     const Buffer<Vec3f>& positions, float step,
                                                     const PieceOrder& order, std::span<const uint32_t> piece_counts,
                                                     const Poller& poller);

}  // namespace papilio
