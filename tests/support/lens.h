#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio::test {

/// Normals of a mesh.
enum class Shading : uint8_t { absent, smooth, hard_rim, faceted };

/// A closed lens of two spherical caps of radius 1 that meet at a rim in the plane z = 0 at an angle of `degrees`: `n`
/// segments about the axis, `m` rings per cap. Normals are those of the caps, split at a hard rim, or of the faces.
[[nodiscard]] TriangleMesh lens(uint32_t n, uint32_t m, double degrees, Shading shading);

/// Returns the normal of the lens's upper or lower cap in the direction of a point of its surface.
[[nodiscard]] Vec3d lens_normal(Vec3f point, double degrees, bool is_upper);

}  // namespace papilio::test
