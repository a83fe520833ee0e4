#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "papilio/mesh.h"

// Meshes with texture coordinates of closed form as their only attribute. Points are split only at seams.

namespace papilio::test {

using Texcoord = std::array<double, 2>;

/// Gives each corner of each face the value of a function of the face and the corner's number.
[[nodiscard]] TriangleMesh with_texcoords(const TriangleMesh& plain,
                                          const std::function<Texcoord(const Triangle&, size_t)>& texcoord_of);
[[nodiscard]] Texcoord texcoord_at(const TriangleMesh& mesh, uint32_t point);

/// A flat sheet, a unit square of n by n cells, whose inner vertices are moved at random: `sheet_texcoord`.
[[nodiscard]] TriangleMesh flat_sheet(uint32_t n);
/// A linear function.
[[nodiscard]] Texcoord sheet_texcoord(Vec3d place);

/// An open tube of radius 1 about the z axis, 0 to 2, of n by m cells: the angle's share of a turn, and z / 2. One
/// seam.
[[nodiscard]] TriangleMesh textured_tube(uint32_t n, uint32_t m);

/// The unit cube with a chart for each side: `box_texcoord`.
[[nodiscard]] TriangleMesh charted_box(uint32_t cells);
/// Texture coordinates of a place on a side of the unit cube with this normal.
[[nodiscard]] Texcoord box_texcoord(Vec3d normal, Vec3d place);

}  // namespace papilio::test
