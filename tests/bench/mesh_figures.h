#pragma once

#include <array>

#include "papilio/mesh.h"

namespace papilio::bench {

/// In the mesh's unit.
struct SurfaceError {
  double rms = 0, largest = 0;
};

/// From the vertices of the uniform result to the surface of another.
[[nodiscard]] SurfaceError surface_error(const TriangleMesh& uniform, const TriangleMesh& result);

/// Of all triangles with an area, in degrees.
[[nodiscard]] double smallest_angle(const TriangleMesh& mesh);

/// Of a closed mesh: the shares of the vertices with 3, 4, ... 8 edges and with 9 or more.
[[nodiscard]] std::array<double, 7> valence_shares(const TriangleMesh& mesh);

}  // namespace papilio::bench
