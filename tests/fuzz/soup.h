#pragma once

#include "proto/mesh_format.h"
#include "proto/parameters.h"
#include "tests/fuzz/byte_source.h"

namespace papilio::fuzz {

/// Triangles in any arrangement: of coinciding, flat, huge or not-a-number positions, repeated, degenerate, and with up
/// to two attributes of any kind. Indices are in range but for a rare case.
[[nodiscard]] proto::FormattedMesh take_soup(ByteSource& bytes);

/// Any values of the parameters of the table, each in its range; at most `most_levels`. Throws `Problem` where they do
/// not go together.
[[nodiscard]] proto::Parameters take_parameters(ByteSource& bytes, int most_levels);

/// Ends the program unless indices are in range and agree, and positions are finite.
void require_sound(const Mesh& mesh);

}  // namespace papilio::fuzz
