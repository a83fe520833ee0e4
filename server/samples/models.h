#pragma once

#include "papilio/mesh.h"

// Generated samples of the server: a knot, and substitutes for the unavailable models of the paper's Table 1, with
// equal counts and topology. Lengths are in centimetres, z is up. Surfaces are closed and counter-clockwise seen from
// outside, without repeated positions.

namespace papilio::server {

/// Returns a tube along a trefoil knot: 216 vertices, 432 faces, Euler characteristic 0.
[[nodiscard]] TriangleMesh knot();
/// Returns a mug with a handle: 172 vertices, 344 faces, Euler characteristic 0.
[[nodiscard]] TriangleMesh mug();
/// Returns a spoked wheel with its axle along z: tyre, hub and eight spokes, ten closed parts that intersect as in such
/// models. 163 vertices, 290 faces, Euler characteristic 18.
[[nodiscard]] TriangleMesh wheel();

}  // namespace papilio::server
