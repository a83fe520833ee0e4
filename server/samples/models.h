#pragma once

#include "papilio/mesh.h"

// Stand-ins for the models of the paper's Table 1, which cannot be found: the same counts and topology, made by
// program. The server's own samples. Lengths in centimetres, z up. Closed, wound counter-clockwise seen from outside,
// no two positions equal.

namespace papilio::server {

/// A mug with a handle: 172 vertices, 344 faces, Euler characteristic 0.
[[nodiscard]] TriangleMesh mug();
/// A spoked wheel: tyre, hub and eight spokes, ten closed parts that reach into each other as the parts of such models
/// do; the axle along z. 163 vertices, 290 faces, Euler characteristic 18.
[[nodiscard]] TriangleMesh wheel();

}  // namespace papilio::server
