#pragma once

#include <array>

#include "papilio/mesh.h"

namespace papilio::bench {

/// Distances in the mesh's unit.
struct SurfaceError {
  double rms = 0, largest = 0;
};

/// Measures from the vertices of the uniform result to another surface.
[[nodiscard]] SurfaceError surface_error(const TriangleMesh& uniform, const TriangleMesh& result);

/// Returns the smallest angle of all triangles with an area, in degrees.
[[nodiscard]] double smallest_angle(const TriangleMesh& mesh);

/// Returns the shares of the vertices of a closed mesh with 3, 4, ... 8 edges and with 9 or more.
[[nodiscard]] std::array<double, 7> valence_shares(const TriangleMesh& mesh);

}  // namespace papilio::bench
