#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "papilio/mesh.h"
#include "proto/gltf/materials.h"
#include "proto/limits.h"
#include "proto/mesh_format.h"

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
/// where none is. Of attributes, texture coordinates as packed models have them may be there. `material` as of
/// write_packed(). Calls `poll`, unless empty; it may throw to stop. Throws `Problem`.
[[nodiscard]] PlainDraco write_plain_draco(const Mesh& mesh, double rms, const std::function<void()>& poll = {},
                                           const gltf::Materials& material = {});

/// Writes the mesh as write_plain_draco() does, with so many bits of a coordinate.
[[nodiscard]] PlainDraco write_plain_grid(const Mesh& mesh, int position_bits, const std::function<void()>& poll = {},
                                          const gltf::Materials& material = {});

/// Reads the mesh of a file without levels: a .glb scene that shows one primitive once, of positions and perhaps
/// texture coordinates, compressed by Draco. Nothing for other files. Throws `Problem` for a damaged one, and
/// mesh_too_large.
[[nodiscard]] std::optional<FormattedMesh> read_plain_draco(std::string_view glb, const Limits& limits);

}  // namespace papilio::proto::detail
