#pragma once

#include <functional>

#include "criteria/camera.h"
#include "criteria/view_culling.h"
#include "papilio/mesh.h"

namespace papilio {

/// Error allowed to `simplify_hidden`, as a share of the bounding box's diagonal. More leaves hardly fewer faces, since
/// what is left are mostly those at the border of the visible part.
inline constexpr double default_hidden_error = 0.0025;

/// The mesh with the faces that `camera` does not show (`hidden_faces`) simplified: edges are collapsed onto existing
/// vertices (Garland and Heckbert 1997) as long as the error stays under `error`, a share >= 0 of the bounding box's
/// diagonal. The error is the root mean square distance to the planes of the faces that went; the largest distance
/// measured between the surfaces was 1.5 to 2.5 times as much.
///
/// Kept to the bit: each visible face, with its points; each vertex on the border of the visible part, on a curve
/// (boundary, shared, crease), pinched, or on a seam. The curves and the Euler characteristic stay, no edge becomes
/// non-manifold, no face flipped or degenerate. Where that cannot be had, less is simplified, at worst nothing. The
/// visible faces come first, in their order; vertices and points keep their order, less those not used any more. The
/// mesh comes back as it is when nothing is hidden. Deterministic. `poll`, if any, is called between steps, of which
/// each is short whatever the mesh is; it may throw to stop.
///
/// Hidden faces are simplified in parts (collapse.h): from 65,536 of them on a few more are left. Hidden faces at a
/// vertex with more than 256 of them are left as they are.
///
/// By meshoptimizer, not by OpenMesh's Decimater (ModQuadric, locked vertices): 4 to 13 times as fast although what it
/// does is checked and done again, takes what is not manifold, leaves fewer faces folded over, and is a small library
/// to install where the other comes with a viewer. The price: a mean distance 10 to 75 % larger at equal faces.
[[nodiscard]] Mesh simplify_hidden(Mesh mesh, const Camera& camera, double error = default_hidden_error,
                                   const std::function<void()>& poll = {});

}  // namespace papilio
