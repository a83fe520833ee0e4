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

/// One goal holds: `bytes` if it is set, else `largest` if it is set, else `rms`. For the first two, the RMS distance
/// is searched in at most seven encodings (distance_search.h).
struct PackOptions {
  double rms = 1e-4;   ///< wanted RMS distance, a share of the original's diagonal; 1e-6..0.1
  double largest = 0;  ///< largest distance of either direction that is allowed, as above; 1e-6..1; 0: none
  uint64_t bytes = 0;  ///< most bytes of the file; 0: any number
  int jobs = 1;        ///< most threads that encode at once; the file is the same
  uint64_t face_limit = 8'000'000;                     ///< faces of the last level
  uint64_t piece_bytes = DetailOptions{}.piece_bytes;  ///< of a piece of a level, about; > 0
  bool simplifies = false;  ///< whether a simplified mesh is compared too, where the goal is `rms`
  /// Asked now and then; true stops with `Problem` cancelled. Comes from several threads at once with several jobs.
  std::function<bool()> cancelled{};
  std::function<void(double)> on_progress{};  ///< share done, 0..1; calls do not overlap
};

/// A packed original.
struct Packed {
  std::string glb{};
  std::optional<PackedModel> model{};  ///< as read back; nothing: `glb` is plain Draco, perhaps of a simplified mesh
  std::string reason{};                ///< why it is plain
  double wanted_rms = 0;               ///< 0 with another goal
  size_t encodings = 0;                ///< made for the goal
  uint32_t folds = 0;                  ///< faces of the last level turned against the original
  uint64_t plain_bytes = 0;            ///< of the plain .glb file at the same distance
  int plain_bits = 0;                  ///< its bits of a coordinate
  double plain_rms = 0;                ///< its distance, by `grid_rms`
  bool plain_has_normals = false;      ///< whether normals are in its Draco, as readers would not find them
  std::optional<SimplifiedDraco> simplified{};  ///< what was compared; its `glb` is moved out where it is the result
  uint64_t image_bytes = 0;                     ///< of the material's images
  uint32_t parted = 0;                          ///< vertices at which the original touches itself, which were parted
};

/// Packs an original: its surface, its first texture coordinates of two components, its first colours without
/// their opacity, the style of its normals (`NormalStyle`), and the materials of its triangles. The result is a plain
/// .glb file where the surface cannot be packed, and where plain Draco is as good: at the RMS distance that was reached
/// or at the largest allowed distance it takes no more bytes, or in as many bytes it has no larger an RMS distance. For
/// an RMS distance a simplified mesh as Draco is compared too, if asked, from 5,000 faces on and if there is none of
/// what it would lose: texture coordinates, colours, several materials, normals of hard edges. Throws `Problem`:
/// result_too_large where no file found is so small; and as the coders.
[[nodiscard]] Packed pack(const gltf::MaterialMesh& original, const PackOptions& options);
/// Packs a surface; its attributes are left out.
[[nodiscard]] Packed pack(const TriangleMesh& original, const PackOptions& options);

/// Returns JSON that describes a packed model: its base and levels with counts, bytes and distances.
[[nodiscard]] std::string describe(const PackedModel& model);

/// Returns the statistics of `pack` as JSON.
[[nodiscard]] std::string pack_report(const Packed& packed);

}  // namespace papilio::proto::detail
