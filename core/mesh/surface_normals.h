#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio {

/// What the normals of a vertex's faces count by in its normal.
enum class FaceWeight : uint8_t {
  area,
  angle,  ///< at the vertex: what modelling programs do
};

/// Adds normals as add_normals() does, with these weights.
void add_weighted_normals(Mesh& mesh, FaceWeight weight);

}  // namespace papilio
