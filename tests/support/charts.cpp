#include "tests/support/charts.h"

#include <array>
#include <cmath>
#include <map>

namespace papilio::test {

using proto::AttributeKind;
using proto::FormattedMesh;
using proto::ValueType;

void add_attribute(FormattedMesh& mesh, AttributeKind kind, ValueType type, uint32_t components,
                   std::vector<double> values) {
  mesh.attributes.push_back(
      {components, kind == AttributeKind::normal && type == ValueType::float32 && components == 3, std::move(values)});
  mesh.format.attributes.push_back({.kind = kind, .type = type, .id = static_cast<uint32_t>(mesh.attributes.size())});
}

FormattedMesh charted_cube() {
  // Sides by their corners, whose bits are x, y and z.
  constexpr std::array<std::array<uint32_t, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  FormattedMesh mesh;
  std::vector<double> numbers;
  std::vector<double> coordinates;
  for (uint32_t k = 0; k < 6; ++k) {
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t c = sides[k][i];
      mesh.positions.push_back(
          {static_cast<float>(c & 1U), static_cast<float>(c >> 1U & 1U), static_cast<float>(c >> 2U)});
      numbers.push_back(k);
      coordinates.insert(coordinates.end(), {2.0 * k + (i == 1 || i == 2 ? 1 : 0), i >= 2 ? 1.0 : 0.0});
    }
    mesh.triangles.push_back({4 * k, 4 * k + 1, 4 * k + 2});
    mesh.triangles.push_back({4 * k, 4 * k + 2, 4 * k + 3});
  }
  add_attribute(mesh, AttributeKind::generic, ValueType::int32, 1, numbers);
  add_attribute(mesh, AttributeKind::tex_coord, ValueType::float32, 2, coordinates);
  return mesh;
}

FormattedMesh charted_faces(const TriangleMesh& plain) {
  FormattedMesh mesh;
  std::vector<double> numbers;
  std::vector<double> coordinates;
  for (uint32_t f = 0; f < plain.triangles.size(); ++f) {
    for (uint32_t p : plain.triangles[f]) mesh.positions.push_back(plain.positions[p]);
    numbers.insert(numbers.end(), 3, f);
    coordinates.insert(coordinates.end(), {0, 0, 1, 0, 0, 1});
    mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  add_attribute(mesh, AttributeKind::generic, ValueType::int32, 1, numbers);
  add_attribute(mesh, AttributeKind::tex_coord, ValueType::float32, 2, coordinates);
  return mesh;
}

::testing::AssertionResult tiles_its_charts(const TriangleMesh& mesh, double area, double slack) {
  const std::vector<double>& number = mesh.attributes[chart_number].values;
  const std::vector<double>& at = mesh.attributes[chart_coordinates].values;
  std::map<double, double> areas;
  for (const auto& [a, b, c] : mesh.triangles) {
    if (number[a] != number[b] || number[b] != number[c]) return ::testing::AssertionFailure() << "crosses charts";
    const double twice = (at[2 * b] - at[2 * a]) * (at[2 * c + 1] - at[2 * a + 1]) -
                         (at[2 * c] - at[2 * a]) * (at[2 * b + 1] - at[2 * a + 1]);
    if (!(twice > 0)) return ::testing::AssertionFailure() << "turned over in chart " << number[a];
    areas[number[a]] += twice / 2;
  }
  for (const auto& [chart, sum] : areas)
    if (!(std::abs(sum - area) <= slack)) return ::testing::AssertionFailure() << "chart " << chart << " has " << sum;
  return ::testing::AssertionSuccess();
}

}  // namespace papilio::test
