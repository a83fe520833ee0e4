#pragma once

#include <gtest/gtest.h>

#include "proto/mesh_format.h"

// Meshes with attributes that have a closed form, for tests. The first two of their attributes are always the number of
// the chart and coordinates in it, an affine function on every coarse face.

namespace papilio::test {

inline constexpr size_t chart_number = 0;
inline constexpr size_t chart_coordinates = 1;

/// The cube from 0 to 1: six charts, one a side, 24 points. Coordinates fill the squares (2 k..2 k + 1, 0..1).
[[nodiscard]] proto::FormattedMesh charted_cube();

/// Every face a chart of its own, with three points. Coordinates are (0, 0), (1, 0), (0, 1).
[[nodiscard]] proto::FormattedMesh charted_faces(const TriangleMesh& plain);

/// Adds an attribute; its id is its number, counted from 1.
void add_attribute(proto::FormattedMesh& mesh, proto::AttributeKind kind, proto::ValueType type, uint32_t components,
                   std::vector<double> values);

/// The triangles, in the chart's coordinates, tile each chart: none is turned over, none crosses to another chart, and
/// the areas add up to `area`, but for `slack`.
[[nodiscard]] ::testing::AssertionResult tiles_its_charts(const TriangleMesh& mesh, double area, double slack = 0);

}  // namespace papilio::test
