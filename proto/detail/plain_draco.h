#pragma once

#include <functional>
#include <string>

#include "papilio/mesh.h"

namespace papilio::proto::detail {

/// A mesh without levels, for comparison and where it is smaller.
struct PlainDraco {
  std::string glb{};
  int position_bits = 0;
  double rms = 0;  ///< distance that the grid leaves; share of the diagonal
};

/// Returns the RMS distance between a surface and the one with positions on the grid of so many bits in its
/// `tight_box`, a share of the bounding box's diagonal: of the linearly interpolated moves, the part along the faces'
/// normals. Second orders are left out.
[[nodiscard]] double grid_rms(const Mesh& mesh, int position_bits);

/// Writes the mesh as Draco at speed 0 with the fewest bits, from 6 to 20, whose `grid_rms` is at most `rms`; with 20
/// where none is. Attributes are left out. Calls `poll`, unless empty; it may throw to stop. Throws `Problem`.
[[nodiscard]] PlainDraco write_plain_draco(const Mesh& mesh, double rms, const std::function<void()>& poll = {});

}  // namespace papilio::proto::detail
