#pragma once

#include <gtest/gtest.h>

#include "proto/mesh_format.h"

// Meshes with attributes of closed form. The first two attributes are the number of the chart and coordinates in it, an
// affine function on every coarse face.

namespace papilio::test {

inline constexpr size_t chart_number = 0;
inline constexpr size_t chart_coordinates = 1;

/// The unit cube with six charts, one per side, and 24 points. Coordinates fill the squares (2 k..2 k + 1, 0..1).
[[nodiscard]] proto::FormattedMesh charted_cube();

/// Returns the mesh with a chart of three points per face. Coordinates are (0, 0), (1, 0), (0, 1).
[[nodiscard]] proto::FormattedMesh charted_faces(const TriangleMesh& plain);

/// Adds an attribute; its id is its number, counted from 1.
void add_attribute(proto::FormattedMesh& mesh, proto::AttributeKind kind, proto::ValueType type, uint32_t components,
                   std::vector<double> values);

/// Expects that the triangles tile each chart in its coordinates: none is reversed or spans two charts, and their areas
/// add up to `area` within `slack`.
[[nodiscard]] ::testing::AssertionResult tiles_its_charts(const TriangleMesh& mesh, double area, double slack = 0);

}  // namespace papilio::test
