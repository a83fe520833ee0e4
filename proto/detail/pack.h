#pragma once

#include <functional>
#include <optional>
#include <string>

#include "proto/detail/packed_model.h"
#include "proto/detail/plain_draco.h"
#include "proto/limits.h"

namespace papilio::proto::detail {

struct PackOptions {
  double rms = 1e-4;                          ///< wanted RMS distance, a share of the original's diagonal; 1e-6..0.1
  uint64_t face_limit = 8'000'000;            ///< faces of the last level
  std::function<bool()> cancelled{};          ///< asked now and then; true stops with `Problem` cancelled
  std::function<void(double)> on_progress{};  ///< share done, 0..1
};

/// A packed original.
struct Packed {
  std::string glb{};
  std::optional<PackedModel> model{};  ///< as read back; nothing: `glb` is plain Draco
  std::string reason{};                ///< why it is plain
  double wanted_rms = 0;
  uint32_t folds = 0;        ///< faces of the last level turned against the original
  uint64_t plain_bytes = 0;  ///< of the plain .glb file at the same distance
  int plain_bits = 0;        ///< its bits of a coordinate
  double plain_rms = 0;      ///< its distance, by `grid_rms`
};

/// Packs the surface of an original; its attributes are left out. The result is a plain .glb file at the wanted
/// distance where plain Draco, at the distance that was reached, takes no more bytes than the packed model, and where
/// the surface is not closed and manifold. Throws `Problem`.
[[nodiscard]] Packed pack(const TriangleMesh& original, const PackOptions& options);

/// Returns JSON that describes a packed model: its base and levels with counts, bytes and distances.
[[nodiscard]] std::string describe(const PackedModel& model);

/// Returns the statistics of `pack` as JSON.
[[nodiscard]] std::string pack_report(const Packed& packed);

}  // namespace papilio::proto::detail
