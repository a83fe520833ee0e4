#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vec3.h"

namespace papilio {

/// Three indices into a position array, counter-clockwise seen from outside.
using Triangle = std::array<uint32_t, 3>;

/// Triangles as files and streams carry them: what goes into the core and what comes out. Nothing is promised
/// of it: there may be repeated positions, unused ones, degenerate faces.
struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

}  // namespace papilio
