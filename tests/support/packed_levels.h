#pragma once

#include <cstdint>

#include "papilio/detail.h"

namespace papilio::test {

struct PackedLevels {
  uint32_t base_faces = 60;  ///< approximate
  int levels = 4;
  float step = 1e-4F;  ///< of positions on the last level
  float texcoord_step = 1.0F / 2048;
  uint64_t piece_bytes = 1'000'000;
};

/// Returns the levels of an original, as encode_detail() encodes its last trial, without the search.
[[nodiscard]] DetailSource pack_levels(const TriangleMesh& triangles, const PackedLevels& options = {});

}  // namespace papilio::test
