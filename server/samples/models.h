#pragma once

#include "papilio/mesh.h"

// The server's own samples, made by program: a knot that is round once it is refined, and stand-ins for the models of
// the paper's Table 1, which cannot be found, with the same counts and topology. Lengths in centimetres, z up. Closed,
// wound counter-clockwise seen from outside, no two positions equal.

namespace papilio::server {

/// A tube along a trefoil knot: 216 vertices, 432 faces, Euler characteristic 0.
[[nodiscard]] TriangleMesh knot();
/// A mug with a handle: 172 vertices, 344 faces, Euler characteristic 0.
[[nodiscard]] TriangleMesh mug();
/// A spoked wheel: tyre, hub and eight spokes, ten closed parts that reach into each other as the parts of such models
/// do; the axle along z. 163 vertices, 290 faces, Euler characteristic 18.
[[nodiscard]] TriangleMesh wheel();

}  // namespace papilio::server
