#pragma once

#include <cstdint>
#include <vector>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Version of the extension PAPILIO_detail.
inline constexpr uint64_t detail_version = 3;

/// Level of a packed model.
struct PackedLevel {
  DetailStream stream;
  DetailReach reach;          ///< distances with all levels up to this one; up to the one before if pieces are missing
  size_t missing_pieces = 0;  ///< pieces beyond the end of a cut file
  uint64_t vertices = 0;      ///< new vertices: edges of the level below
  uint64_t faces = 0;         ///< faces of the model at this level
};

/// Packed model in memory.
struct PackedModel {
  DetailBase base;
  uint64_t base_bytes = 0;  ///< length of the base's Draco streams
  DetailReach base_reach;
  NormalStyle normals{};            ///< style of the original's normals
  std::vector<PackedLevel> levels;  ///< levels that were read, coarse first
  size_t declared_levels = 0;       ///< number of levels that the file declares

  [[nodiscard]] std::vector<DetailStream> streams() const;
  [[nodiscard]] bool has_texcoords() const;
  [[nodiscard]] bool has_colours() const;
};

/// Returns the distance of a model with all levels that were read.
[[nodiscard]] DetailReach reach_of(const PackedModel& model);

}  // namespace papilio::proto::detail
