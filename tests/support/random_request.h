#pragma once

#include <random>

#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio::test {

/// Returns a mesh of 2 to a few hundred faces: torus, sphere, box, open patch, fan, pinched vertices or three faces at
/// an edge. Its size is between 1e-3 and 1e3, its distance from the origin up to 1e3. Half of the meshes are exact,
/// with many equal edges; the others are jittered.
[[nodiscard]] TriangleMesh random_small_mesh(std::mt19937& random);

/// Sets the rules of a prepared mesh: tension, w and crease angle.
void choose_rules(std::mt19937& random, Options& options);

/// Sets all other options, with every combination of criteria, projections, lights, near planes and scales, among them
/// more than 1e10 pixels a unit.
void choose_request(std::mt19937& random, const Mesh& mesh, Options& options);

}  // namespace papilio::test
