#pragma once

#include <cstdint>

#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// Upper bounds of the memory that the levels of a refinement take. They hold for both schemes.
class MemoryPlan {
 public:
  MemoryPlan(const Mesh& coarse, const Options& options);

  /// Points at most of a mesh of so many faces after so many levels; vertices where there are no attributes.
  [[nodiscard]] uint64_t points(uint64_t faces, int level) const;
  /// Bytes of so many faces of a level while they are made: `face_bytes` a face, and the attributes.
  [[nodiscard]] uint64_t made(uint64_t faces, int level, uint64_t face_bytes) const;
  /// Bytes of a level that the caller is given, with what the caller needs for it (`Options::output`).
  [[nodiscard]] uint64_t given(uint64_t faces, int level) const;

 private:
  uint64_t coarse_faces_, coarse_points_;
  uint64_t open_ = 0;  ///< half-edges of the coarse mesh at whose edge the next face has other points, or none is
  uint64_t point_bytes_ = 0;   ///< of a point's values
  uint64_t corner_bytes_ = 0;  ///< of a face's point numbers
  int detail_levels_ = 0;      ///< that the coarse mesh's detail gives
  OutputBytes output_;
};

}  // namespace papilio
