#pragma once

#include <cstdint>
#include <string_view>

#include "proto/draco_header.h"

// Guard against a weakness of libdraco's decoder: a split symbol merges two vertices and renumbers all corners of one.
// A stream of a few bytes per face can make decoding quadratic in the faces. For the reader only.

namespace papilio::proto {

/// Limit of renumbered corners in a stream: about a second of work.
inline constexpr uint64_t most_renumbered_corners = 1ULL << 27;

/// Counts the corners that the decoder renumbers in an edgebreaker stream. Stops at damage in the stream and after
/// `most_renumbered_corners`. Returns 0 for the predictive traversal, which is not simulated.
[[nodiscard]] uint64_t count_renumbered_corners(std::string_view bytes, const DracoHeader& header);

/// Throws `Problem` mesh_unsupported for an edgebreaker stream that renumbers more than `most_renumbered_corners`. For
/// the predictive traversal, faces times split symbols is the upper bound. Damaged streams pass: libdraco refuses them.
void require_bounded_merges(std::string_view bytes, const DracoHeader& header);

}  // namespace papilio::proto
