#pragma once

#include <gtest/gtest.h>

#include "papilio/mesh.h"

namespace papilio::test {

/// Every array of the topology agrees with what the triangles alone say: counted anew with a map, independent
/// of the core. That includes: every edge has one or two faces (more only where `kind` says shared), two run
/// in opposite directions, twins are mutual, V - E + F agrees. On a mesh without holes this leaves no room
/// for a T-junction.
[[nodiscard]] ::testing::AssertionResult is_consistent(const Mesh& mesh);

/// Number of edges with one face, and of edges with more than two or with two in the same direction, from
/// triangles alone.
struct EdgeCensus {
  uint64_t edges = 0, boundary = 0, irregular = 0;
};
[[nodiscard]] EdgeCensus count_edges(const TriangleMesh& mesh);

/// V - E + F of the triangles, V counting the vertices that faces use.
[[nodiscard]] int64_t euler_characteristic(const TriangleMesh& mesh);

}  // namespace papilio::test
