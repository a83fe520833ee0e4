#pragma once

#include <functional>
#include <optional>
#include <string>

#include "proto/detail/packed_model.h"
#include "proto/detail/plain_draco.h"
#include "proto/detail/simplified_draco.h"
#include "proto/gltf/materials.h"
#include "proto/limits.h"

namespace papilio::proto::detail {

/// Options of pack(). The goal is `bytes` if it is set, else `largest` if it is set, else `rms`. For the first two, the
/// RMS distance is searched in at most seven encodings (distance_search.h).
struct PackOptions {
  double rms = 1e-4;   ///< target RMS distance, a share of the original's diagonal; 1e-6..0.1
  double largest = 0;  ///< upper bound of the largest distance, a share of the diagonal; 1e-6..1; 0: no bound
  uint64_t bytes = 0;  ///< upper bound of the file's bytes; 0: no bound
  int jobs = 1;        ///< upper bound of concurrent encodings, on which the file does not depend
  uint64_t face_limit = 8'000'000;                     ///< upper bound of the faces of the last level
  uint64_t piece_bytes = DetailOptions{}.piece_bytes;  ///< approximate length of a piece of a level; > 0
  bool simplifies = false;  ///< whether a simplified mesh is compared too, if the goal is `rms`
  /// Function polled regularly; true stops with `Problem` cancelled. With several jobs, it is called concurrently.
  std::function<bool()> cancelled{};
  std::function<void(double)> on_progress{};  ///< share done, 0..1; calls do not overlap
};

/// A packed original.
struct Packed {
  std::string glb{};
  std::optional<PackedModel>
      model{};                     ///< model read back; nothing if `glb` is plain Draco, perhaps of a simplified mesh
  std::string reason{};            ///< reason why `glb` is plain
  double wanted_rms = 0;           ///< target RMS distance; 0 with another goal
  size_t encodings = 0;            ///< number of encodings made for the goal
  uint32_t folds = 0;              ///< faces of the last level turned against the original
  uint64_t plain_bytes = 0;        ///< length of the plain .glb file at an equal distance
  int plain_bits = 0;              ///< bits of a coordinate in the plain file
  double plain_rms = 0;            ///< distance of the plain file, by grid_rms()
  bool plain_has_normals = false;  ///< whether the plain file stores normals, as readers could not derive them
  std::optional<SimplifiedDraco>
      simplified{};          ///< simplified mesh compared; its `glb` is moved out if it is the result
  uint64_t image_bytes = 0;  ///< length of the materials' images
  uint32_t parted = 0;       ///< vertices at which the original touches itself, which were separated
};

/// Packs an original: its surface, first texture coordinates of 2 components, first colours without opacity, style of
/// normals (`NormalStyle`), and materials of triangles.
///
/// The result is a plain .glb file if the surface cannot be packed, if its levels would turn more than 1 % of the faces
/// over (3 % with attributes), or if plain Draco is as good: it takes no more bytes at the reached RMS distance or the
/// largest allowed distance, or has no larger RMS distance at the allowed bytes.
///
/// With `simplifies`, a simplified mesh as Draco is compared too, if the original has at least 5,000 faces and nothing
/// that it would lose: texture coordinates, colours, several materials, or normals of hard edges.
///
/// Throws `Problem`: result_too_large if no file within `bytes` is found; and errors of the coders.
[[nodiscard]] Packed pack(const gltf::MaterialMesh& original, const PackOptions& options);
/// Packs a surface without its attributes.
[[nodiscard]] Packed pack(const TriangleMesh& original, const PackOptions& options);

/// Returns JSON that describes a packed model: its base and levels with counts, bytes and distances.
[[nodiscard]] std::string describe(const PackedModel& model);

/// Returns the statistics of pack() as JSON.
[[nodiscard]] std::string pack_report(const Packed& packed);

}  // namespace papilio::proto::detail
