#pragma once

#include <cstdint>
#include <string_view>

#include "proto/draco_header.h"

// A gap in Draco's decoder: where a split symbol merges two vertices, it renumbers all corners of one of them. A stream
// of a few bytes a face can make that quadratic in the faces. For the reader only.

namespace papilio::proto {

/// Most corners that a stream may have renumbered: about a second of work.
inline constexpr uint64_t most_renumbered_corners = 1ULL << 27;

/// How many corners of an edgebreaker stream are renumbered, as far as the stream is sound and to a little more than
/// `most_renumbered_corners`. 0 for the predictive traversal, which is not followed.
[[nodiscard]] uint64_t count_renumbered_corners(std::string_view bytes, const DracoHeader& header);

/// Throws `Problem` mesh_unsupported for an edgebreaker stream that would have more corners renumbered, and for the
/// predictive traversal where that cannot be excluded. Streams with too few split symbols for that are not followed.
/// Damaged streams pass: Draco refuses them.
void require_bounded_merges(std::string_view bytes, const DracoHeader& header);

}  // namespace papilio::proto
