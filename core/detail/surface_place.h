#pragma once

#include <cstdint>

#include "papilio/vec3.h"

namespace papilio {

/// Place on a surface of triangles: a face and barycentric weights of its corners.
struct SurfacePlace {
  uint32_t face = 0;
  Vec3d weights{1, 0, 0};  ///< sum 1
};

}  // namespace papilio
