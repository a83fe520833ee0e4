#pragma once

#include <cstdint>
#include <vector>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Version of the extension PAPILIO_detail.
inline constexpr uint64_t detail_version = 2;

/// A level of a packed model.
struct PackedLevel {
  DetailStream stream;
  DetailReach reach;          ///< of all levels up to this one; where pieces are missing, up to the one before
  size_t missing_pieces = 0;  ///< behind the end of a file that is cut
  uint64_t vertices = 0;      ///< new vertices: edges of the level below
  uint64_t faces = 0;         ///< faces of the model at this level
};

/// A packed model as its reader has it.
struct PackedModel {
  DetailBase base;
  uint64_t base_bytes = 0;  ///< of its Draco stream
  DetailReach base_reach;
  NormalStyle normals{};            ///< of the original
  std::vector<PackedLevel> levels;  ///< those that were read, coarse first
  size_t declared_levels = 0;       ///< those that the file declares

  [[nodiscard]] std::vector<DetailStream> streams() const;
  [[nodiscard]] bool has_texcoords() const;
  [[nodiscard]] bool has_colours() const;
};

/// Returns the distance of a model with all levels that were read.
[[nodiscard]] DetailReach reach_of(const PackedModel& model);

}  // namespace papilio::proto::detail
