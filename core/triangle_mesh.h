#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "array.h"
#include "vec3.h"

namespace papilio {

/// Three indices into a position array, counter-clockwise seen from outside.
using Triangle = std::array<uint32_t, 3>;

/// Values that go with the points: texture coordinates, normals, colours, anything. They are interpolated linearly.
struct Attribute {
  uint32_t components = 1;
  bool unit_length = false;    ///< brought back to length one after interpolation: normals
  std::vector<double> values;  ///< [points * components], point by point

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// Triangles as files and streams carry them: what goes into the core and what comes out. Nothing is promised
/// of it: there may be repeated positions, unused ones, degenerate faces. Points that share a position but not their
/// attributes are a seam.
struct TriangleMesh {
  Array<Vec3f> positions;  ///< [points]
  Array<Triangle> triangles;
  std::vector<Attribute> attributes{};

  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

}  // namespace papilio
