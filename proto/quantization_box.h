#pragma once

#include "papilio/mesh.h"

namespace papilio::proto {

/// Cube whose grid quantizes positions. It depends on the coarse mesh alone, so a vertex keeps its position in all
/// levels and views.
struct QuantizationBox {
  Vec3f origin;     ///< lowest corner
  float range = 0;  ///< edge length
};

/// Lower bound of a grid's edge length: below, steps per unit overflow in Draco.
inline constexpr double least_range = 1e-30;

/// Returns the cube about the centre of the bounding box. Its edge is the longest side of the box, padded by an eighth
/// at both ends because refinement expands the surface. Draco's grid also encodes positions beyond the cube. Throws
/// `Problem` mesh_unusable for a mesh smaller than 1e-30.
[[nodiscard]] QuantizationBox quantization_box(const Buffer<Vec3f>& coarse);

/// Returns the largest distance by which a grid of `position_bits` moves a position of a mesh with this bounding box.
[[nodiscard]] double grid_distance(const Box& coarse, int position_bits);

/// Returns what a grid leaves of a tolerance for the refinement: at least half of it. Both are shares of the diagonal.
[[nodiscard]] double tolerance_beside_grid(double tolerance, double grid_error);

}  // namespace papilio::proto
