#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "proto/draco_reader.h"
#include "proto/gltf/draco_primitive.h"
#include "proto/quantization_box.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

/// An attribute of random numbers.
struct RandomAttribute {
  const char* semantic;
  ElementFormat format;
  double low, high;
};

constexpr double highest_float = std::numeric_limits<float>::max();

/// Returns attributes of each coding: octahedral normals, grids, raw floats, and integers of each type.
std::vector<std::vector<RandomAttribute>> attribute_lists() {
  using enum ComponentType;
  return {{{"NORMAL", {float32, 3, false}, -1, 1},
           {"TEXCOORD_0", {float32, 2, false}, -3, 7},
           {"TANGENT", {float32, 4, false}, -1, 1},
           {"COLOR_0", {uint8, 4, true}, 0, 255},
           {"JOINTS_0", {uint8, 4, false}, 0, 90},
           {"WEIGHTS_0", {float32, 4, false}, 0, 1}},
          {{"NORMAL", {int8, 3, true}, -127, 127},
           {"TEXCOORD_0", {uint16, 2, true}, 0, 65535},
           {"TEXCOORD_1", {int16, 2, false}, -32768, 32767},
           {"COLOR_0", {float32, 3, false}, 0.25, 0.5},
           {"JOINTS_0", {uint16, 4, false}, 3, 700},
           {"_FEATURE_ID_0", {uint32, 1, false}, 5, 900}},
          {{"NORMAL", {float32, 3, false}, 0, 1e-8},
           {"TEXCOORD_0", {float32, 2, false}, 0.125, 0.125},
           {"_LARGE", {uint32, 1, false}, 0, 4294967295.0},
           {"_WIDE", {float32, 2, false}, -highest_float, highest_float},
           {"_NARROW", {float32, 1, false}, 1e6, 1e6 + 1},
           {"_ZERO", {float32, 1, false}, -1e-38, 0}}};
}

VertexStream random_stream(const RandomAttribute& attribute, uint32_t accessor, uint64_t count, std::mt19937& random) {
  VertexStream stream{attribute.semantic, accessor, zero_elements(attribute.format, count)};
  std::uniform_real_distribution<double> share(0, 1);
  for (uint64_t i = 0; i < count; ++i)
    for (uint32_t c = 0; c < attribute.format.components; ++c) {
      const double t = random() % 8 == 0 ? static_cast<double>(random() % 3) / 2 : share(random);
      stream.elements.set_number(i, c, (1 - t) * attribute.low + t * attribute.high);
    }
  return stream;
}

/// A primitive and its document, whose accessors declare bounds.
struct BoundedPrimitive {
  VertexSet set;
  Buffer<Triangle> triangles;
  Json document{{"accessors", Json::array()}};
};

/// Returns a surface with attributes. `is_soup`: each corner is a separate vertex, and some triangles are repeated,
/// without area, or removed with their vertices.
BoundedPrimitive bounded_primitive(const TriangleMesh& mesh, const std::vector<RandomAttribute>& attributes,
                                   bool is_soup, std::mt19937& random) {
  BoundedPrimitive made;
  Buffer<Vec3f> positions = mesh.positions;
  made.triangles = mesh.triangles;
  if (is_soup) {
    positions = {};
    made.triangles = {};
    for (const Triangle& triangle : mesh.triangles) {
      const auto first = static_cast<uint32_t>(positions.size());
      for (const uint32_t v : triangle) positions.push_back(mesh.positions[v]);
      if (first > 0 && random() % 5 == 0) continue;
      made.triangles.push_back({first, first + 1, first + 2});
      if (random() % 5 == 0) made.triangles.push_back({first + 1, first + 2, first});
      if (random() % 5 == 0) made.triangles.push_back({first, first, first + 1});
    }
  }
  made.set.count = positions.size();
  Elements elements = zero_elements({ComponentType::float32, 3, false}, positions.size());
  for (size_t v = 0; v < positions.size(); ++v) {
    elements.set_number(v, 0, positions[v].x);
    elements.set_number(v, 1, positions[v].y);
    elements.set_number(v, 2, positions[v].z);
  }
  made.set.attributes.push_back({"POSITION", 0, std::move(elements)});
  for (const RandomAttribute& attribute : attributes) {
    const auto accessor = static_cast<uint32_t>(made.set.attributes.size());
    made.set.attributes.push_back(random_stream(attribute, accessor, positions.size(), random));
  }
  for (size_t a = 0; a < made.set.attributes.size(); ++a)
    made.document["accessors"].push_back({{"min", Json::array()}, {"max", Json::array()}});
  return made;
}

/// Returns the lowest and highest numbers of the components of an attribute as libdraco decodes it.
std::pair<std::vector<double>, std::vector<double>> decoded_bounds_of(const FormattedMesh& mesh, uint32_t id) {
  const auto found = std::ranges::find(mesh.format.attributes, id, &AttributeFormat::id);
  const Attribute& attribute = mesh.attributes.at(static_cast<size_t>(found - mesh.format.attributes.begin()));
  const size_t components = attribute.components;
  std::pair<std::vector<double>, std::vector<double>> bounds;
  bounds.first.assign(attribute.values.begin(), attribute.values.begin() + components);
  bounds.second = bounds.first;
  for (size_t i = 0; i < attribute.values.size(); ++i) {
    double& low = bounds.first[i % components];
    double& high = bounds.second[i % components];
    low = std::min(low, attribute.values[i]);
    high = std::max(high, attribute.values[i]);
  }
  return bounds;
}

TEST(DracoBounds, StatedBoundsEqualTheDecoded) {
  std::mt19937 random(11);
  std::vector<TriangleMesh> surfaces{test::tetrahedron(), test::torus(9, 8), test::grid(7, 5), test::bipyramid(9)};
  for (int i = 0; i < 8; ++i) surfaces.push_back(test::random_manifold(random));
  const QuantizationBox box = quantization_box(test::grid(9, 9).positions);
  for (const TriangleMesh& surface : surfaces)
    for (const std::vector<RandomAttribute>& attributes : attribute_lists())
      for (const bool is_soup : {false, true})
        for (const int speed : {0, 3, 7, 10}) {
          const BoundedPrimitive primitive = bounded_primitive(surface, attributes, is_soup, random);
          const DracoContent made = encode_draco_primitive(primitive.document, primitive.set, primitive.triangles, {},
                                                           box, {.position_bits = 12, .speed = speed});
          const FormattedMesh decoded = read_draco(made.stream, {});
          ASSERT_EQ(made.attributes.size(), 1 + attributes.size());
          for (size_t a = 1; a < made.attributes.size(); ++a) {
            const auto& [semantic, summary] = made.attributes[a];
            const auto [low, high] = decoded_bounds_of(decoded, made.ids[a].second);
            ASSERT_TRUE(summary.bounds.has_value()) << semantic;
            EXPECT_EQ(summary.bounds->first.get<std::vector<double>>(), low) << semantic << " at speed " << speed;
            EXPECT_EQ(summary.bounds->second.get<std::vector<double>>(), high) << semantic << " at speed " << speed;
            EXPECT_EQ(summary.bounds->first[0].is_number_float(), summary.format.type == ComponentType::float32);
          }
        }
}

}  // namespace
}  // namespace papilio::proto::gltf
