#pragma once

#include "proto/mesh_format.h"
#include "proto/parameters.h"
#include "tests/fuzz/byte_source.h"

namespace papilio::fuzz {

/// Returns triangles in any arrangement: coinciding, flat, huge or NaN positions, repeated and degenerate faces, and up
/// to two attributes of any kind. Indices are rarely out of range.
[[nodiscard]] proto::FormattedMesh take_soup(ByteSource& bytes);

/// Returns any values of the parameters of the table, each in its range, with at most `most_levels` levels. Throws
/// `Problem` if the combination is invalid.
[[nodiscard]] proto::Parameters take_parameters(ByteSource& bytes, int most_levels);

/// Aborts unless indices are in range and consistent, and positions are finite.
void require_sound(const Mesh& mesh);

}  // namespace papilio::fuzz
