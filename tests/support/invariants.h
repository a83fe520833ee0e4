#pragma once

#include <gtest/gtest.h>

#include "papilio/mesh.h"

namespace papilio::test {

/// Returns whether every array of the topology agrees with the triangles, checked with a map independent of the core.
/// Every edge has one or two faces (more only if `kind` is shared), two faces run in opposite directions, twins are
/// mutual, and V - E + F agrees. A mesh without holes then has no T-junctions.
[[nodiscard]] ::testing::AssertionResult is_consistent(const Mesh& mesh);

/// Returns the number of edges with one face, and of edges with more than two faces or with two in the same direction,
/// computed from the triangles.
struct EdgeCensus {
  uint64_t edges = 0, boundary = 0, irregular = 0;
};
[[nodiscard]] EdgeCensus count_edges(const TriangleMesh& mesh);

/// Returns V - E + F of the triangles; V counts the vertices of faces.
[[nodiscard]] int64_t euler_characteristic(const TriangleMesh& mesh);

}  // namespace papilio::test
