#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio {

/// Weight of a face's normal in the normal of its vertex.
enum class FaceWeight : uint8_t {
  area,
  angle,  ///< angle at the vertex, as in modelling programs
};

/// Adds normals as add_normals(), with face normals weighted by `weight`.
void add_weighted_normals(Mesh& mesh, FaceWeight weight);

}  // namespace papilio
