#pragma once

#include <cstdint>

#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// Upper bounds of the memory of a refinement's levels, in either scheme.
class MemoryPlan {
 public:
  MemoryPlan(const Mesh& coarse, const Options& options);

  /// Returns an upper bound of the points of `faces` faces after `level` levels; of the vertices without attributes.
  [[nodiscard]] uint64_t points(uint64_t faces, int level) const;
  /// Returns an upper bound of the bytes of `faces` faces of a level while it is made: `face_bytes` a face, and
  /// attributes.
  [[nodiscard]] uint64_t made(uint64_t faces, int level, uint64_t face_bytes) const;
  /// Returns an upper bound of the bytes of a level passed to the caller, including `Options::output`.
  [[nodiscard]] uint64_t given(uint64_t faces, int level) const;

 private:
  uint64_t coarse_faces_, coarse_points_;
  uint64_t open_ = 0;          ///< half-edges of the coarse mesh at a seam, or without a twin
  uint64_t point_bytes_ = 0;   ///< bytes of a point's values
  uint64_t corner_bytes_ = 0;  ///< bytes of a face's point numbers
  int detail_levels_ = 0;      ///< levels of the coarse mesh's detail
  OutputBytes output_;
};

}  // namespace papilio
