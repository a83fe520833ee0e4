#pragma once

#include <cstdint>
#include <span>

#include "papilio/mesh.h"

namespace papilio::client {

/// A polygon as a fan of triangles around its first corner; nothing for one or two corners.
inline void append_fan(std::span<const uint32_t> corners, Buffer<Triangle>& triangles) {
  for (size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace papilio::client
