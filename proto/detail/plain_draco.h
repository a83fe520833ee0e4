#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "papilio/detail.h"
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

/// What is written besides the mesh.
struct PlainOptions {
  std::function<void()> poll{};                ///< called now and then; may throw to stop
  const gltf::Materials* materials = nullptr;  ///< as of write_packed()
  NormalStyle normals{};                       ///< of the original, for readers of a mesh without
};

/// Returns the RMS distance between a surface and the one with positions on the grid of so many bits in its
/// `tight_box`, a share of the bounding box's diagonal: of the linearly interpolated moves, the part along the faces'
/// normals. Second orders are left out.
[[nodiscard]] double grid_rms(const Mesh& mesh, int position_bits);

/// Writes the mesh as Draco at speed 0 with the fewest bits, from 6 to 20, whose `grid_rms` is at most `rms`; with 20
/// where none is. Of attributes, those of packed models may be there, and normals.
/// Throws `Problem`.
[[nodiscard]] PlainDraco write_plain_draco(const Mesh& mesh, double rms, const PlainOptions& options = {});

/// Writes the mesh as write_plain_draco() does, with so many bits of a coordinate.
[[nodiscard]] PlainDraco write_plain_grid(const Mesh& mesh, int position_bits, const PlainOptions& options = {});

/// A mesh of a file without levels.
struct PlainModel {
  FormattedMesh mesh;
  NormalStyle normals{};  ///< of the original, where the file has none
};

/// Reads the mesh of a file without levels: a .glb scene that shows one mesh once, whose primitives are of positions
/// and perhaps texture coordinates, colours and normals, compressed by Draco. Nothing for other files. Throws `Problem`
/// for a damaged one, and mesh_too_large.
[[nodiscard]] std::optional<PlainModel> read_plain_draco(std::string_view glb, const Limits& limits);

/// Gives a mesh of a file without levels normals of a style in place of its own: smooth ones, or split at the edges
/// that are sharp by their angle. None for other styles. Throws what build_mesh() throws.
[[nodiscard]] FormattedMesh with_normals(FormattedMesh mesh, NormalStyle style);
/// The same where the original has none: split at those edges and, where it is mechanical, at the creases of its shape
/// (`Shape::automatic`), also where a coarse grid makes them jagged. Throws also what refine() throws.
[[nodiscard]] FormattedMesh with_normals_of_shape(FormattedMesh mesh);

}  // namespace papilio::proto::detail
