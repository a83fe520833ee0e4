#pragma once

#include <random>

#include "papilio/mesh.h"
#include "papilio/options.h"

// Meshes and requests for comparisons with a reference of other precision: ties are rare, and most criteria hold in
// part of the mesh only.

namespace papilio::test {

/// Moves each point by up to this share of the bounding box, in place.
void jitter(std::mt19937& random, double share, TriangleMesh& mesh);

/// Returns a jittered mesh of up to about a hundred faces: closed, open, of high valence, in some cases with pinched
/// vertices, shared edges and faces wound against their neighbours. No two faces share all three vertices.
[[nodiscard]] TriangleMesh jittered_mesh(std::mt19937& random);

/// Returns options of either scheme with some criteria, rules of all kinds, and at most so many faces if uniform.
[[nodiscard]] Options decisive_request(std::mt19937& random, const Mesh& mesh, uint64_t most_faces);

}  // namespace papilio::test
