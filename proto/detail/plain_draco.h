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

/// File of a mesh without levels.
struct PlainDraco {
  std::string glb{};
  int position_bits = 0;
  double rms = 0;  ///< RMS distance that the grid leaves, a share of the diagonal
};

/// Options of a file without levels.
struct PlainOptions {
  std::function<void()> poll{};                ///< called regularly; may throw to stop
  const gltf::Materials* materials = nullptr;  ///< argument of write_packed()
  NormalStyle normals{};                       ///< style of the original's normals, if the mesh has none
};

/// Returns the RMS distance between a surface and its positions on a grid of `position_bits` in its `tight_box`, a
/// share of the bounding box's diagonal. It is the part of the linearly interpolated moves along the faces' normals, to
/// first order.
[[nodiscard]] double grid_rms(const Mesh& mesh, int position_bits);

/// Writes the mesh as Draco at speed 0, with the fewest of 6 to 20 bits whose grid_rms() is at most `rms`; with 20 if
/// none is. Attributes may be those of packed models, and normals. Throws `Problem`.
[[nodiscard]] PlainDraco write_plain_draco(const Mesh& mesh, double rms, const PlainOptions& options = {});

/// Writes the mesh as write_plain_draco() does, with `position_bits`.
[[nodiscard]] PlainDraco write_plain_grid(const Mesh& mesh, int position_bits, const PlainOptions& options = {});

/// Mesh of a file without levels.
struct PlainModel {
  FormattedMesh mesh;
  NormalStyle normals{};  ///< style of the original's normals, if the file has none
};

/// Reads the mesh of a file without levels: a .glb scene with one instance of one mesh, whose primitives have positions
/// and perhaps texture coordinates, colours and normals, compressed by Draco. Returns nothing for other files. Throws
/// `Problem` for a damaged file, and mesh_too_large.
[[nodiscard]] std::optional<PlainModel> read_plain_draco(std::string_view glb, const Limits& limits);

/// Replaces the normals of a mesh of a file without levels: by smooth ones, by ones split at edges of a sharp angle, or
/// by none in other styles. Throws errors of build_mesh().
[[nodiscard]] FormattedMesh with_normals(FormattedMesh mesh, NormalStyle style);
/// Adds normals to a mesh whose original has none: split at edges of a sharp angle and, on mechanical parts, at the
/// creases of the shape (`Shape::automatic`), even if a coarse grid makes them jagged. Throws errors of build_mesh()
/// and refine().
[[nodiscard]] FormattedMesh with_normals_of_shape(FormattedMesh mesh);

}  // namespace papilio::proto::detail
