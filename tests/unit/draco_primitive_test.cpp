#include "proto/gltf/draco_primitive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "proto/draco_reader.h"
#include "proto/quantization_box.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

/// A primitive and the document of its accessors: POSITION, one per attribute, then indices.
struct Primitive {
  VertexSet set;
  Buffer<Triangle> triangles;
  Json document{{"accessors", Json::array()}};
  uint32_t indices = 0;
};

Elements floats(const std::vector<float>& numbers, uint32_t components) {
  Elements out = zero_elements({ComponentType::float32, components, false}, numbers.size() / components);
  for (size_t i = 0; i < numbers.size(); ++i) out.set_number(i / components, i % components, numbers[i]);
  return out;
}

void add_stream(Primitive& primitive, const char* semantic, Elements elements, bool declares_bounds) {
  const auto accessor = static_cast<uint32_t>(primitive.document["accessors"].size());
  Json described = Json::object();
  if (declares_bounds) described["min"] = described["max"] = Json::array();
  primitive.document["accessors"].push_back(std::move(described));
  primitive.set.attributes.push_back({semantic, accessor, std::move(elements)});
}

/// Returns a surface with a separate vertex per corner and random attributes, so that seams cross, end and close.
/// `is_repetitive`: some triangles are repeated or have no area.
Primitive random_primitive(const TriangleMesh& mesh, uint32_t seed, bool is_repetitive, bool declares_bounds) {
  std::mt19937 random(seed);
  Primitive out;
  std::vector<float> positions, places, kinds;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<uint32_t>(positions.size() / 3);
    for (const uint32_t v : triangle) {
      const Vec3f p = mesh.positions[v];
      positions.insert(positions.end(), {p.x == 0 && random() % 2 == 0 ? -0.0F : p.x, p.y, p.z});
      places.insert(places.end(), {p.x + static_cast<float>(random() % 5 == 0 ? 1 : 0), p.y});
      kinds.push_back(static_cast<float>(random() % 9 == 0 ? random() % 3 : 7));
    }
    out.triangles.push_back({first, first + 1, first + 2});
    if (is_repetitive && random() % 4 == 0) out.triangles.push_back({first + 1, first + 2, first});
    if (is_repetitive && random() % 4 == 0) out.triangles.push_back({first, first, first + 2});
  }
  out.set.count = positions.size() / 3;
  add_stream(out, "POSITION", floats(positions, 3), true);
  add_stream(out, "TEXCOORD_0", floats(places, 2), declares_bounds);
  Elements identifiers = zero_elements({ComponentType::uint16, 1, false}, kinds.size());
  for (size_t i = 0; i < kinds.size(); ++i) identifiers.set_number(i, 0, kinds[i]);
  add_stream(out, "_KIND", std::move(identifiers), false);
  out.indices = static_cast<uint32_t>(out.document["accessors"].size());
  out.document["accessors"].push_back({{"min", Json::array()}});
  return out;
}

std::vector<TriangleMesh> surfaces() {
  std::mt19937 random(5);
  return {test::tetrahedron(),
          test::torus(7, 9),
          test::grid(6, 5),
          test::bipyramid(12),
          test::random_manifold(random),
          test::join(test::grid(3, 3), test::cube(), 4)};
}

DracoContent encode(const Primitive& primitive, int speed) {
  const QuantizationBox box = quantization_box(test::torus(7, 9).positions);
  return encode_draco_primitive(primitive.document, primitive.set, primitive.triangles, primitive.indices, box,
                                {.position_bits = 12, .speed = speed});
}

/// Builds the core's mesh from all attributes and writes it.
std::string encode_by_core(const Primitive& primitive, int speed) {
  const Elements& positions = primitive.set.attributes[0].elements;
  FormattedMesh input;
  input.triangles = primitive.triangles;
  for (uint64_t v = 0; v < positions.count; ++v)
    input.positions.push_back({static_cast<float>(positions.number(v, 0)), static_cast<float>(positions.number(v, 1)),
                               static_cast<float>(positions.number(v, 2))});
  const std::vector<std::pair<AttributeKind, ValueType>> formats{{AttributeKind::tex_coord, ValueType::float32},
                                                                 {AttributeKind::generic, ValueType::uint16}};
  for (uint32_t a = 0; a < formats.size(); ++a) {
    const Elements& elements = primitive.set.attributes[a + 1].elements;
    Attribute attribute{.components = elements.format.components, .values = {}};
    for (uint64_t v = 0; v < elements.count; ++v)
      for (uint32_t c = 0; c < elements.format.components; ++c) attribute.values.push_back(elements.number(v, c));
    input.attributes.push_back(std::move(attribute));
    input.format.attributes.push_back({.kind = formats[a].first, .type = formats[a].second, .id = a + 1});
  }
  const Mesh mesh = build_mesh(input);
  return write_draco(mesh, quantization_box(test::torus(7, 9).positions), {.position_bits = 12, .speed = speed},
                     attribute_encoding(mesh, input.format));
}

TEST(DracoPrimitive, StreamEqualsTheCoresWithAllAttributes) {
  uint32_t seed = 0;
  for (const TriangleMesh& surface : surfaces())
    for (const bool is_repetitive : {false, true})
      for (const int speed : {0, 5, 7, 10}) {
        const Primitive primitive = random_primitive(surface, ++seed, is_repetitive, false);
        EXPECT_EQ(encode(primitive, speed).stream, encode_by_core(primitive, speed)) << seed;
      }
}

TEST(DracoPrimitive, DescriptionMatchesTheDecodedPrimitive) {
  uint32_t seed = 100;
  for (const TriangleMesh& surface : surfaces())
    for (const bool declares_bounds : {false, true})
      for (const int speed : {0, 5, 7, 10}) {
        const Primitive primitive = random_primitive(surface, ++seed, false, declares_bounds);
        const DracoContent made = encode(primitive, speed);
        const FormattedMesh decoded = read_draco(made.stream, {});
        for (const auto& [semantic, summary] : made.attributes) {
          EXPECT_EQ(summary.count, decoded.positions.size()) << semantic << seed;
          EXPECT_EQ(summary.bounds.has_value(),
                    semantic == "POSITION" || (semantic == "TEXCOORD_0" && declares_bounds));
        }
        const Box box = bounding_box(decoded.positions);
        const auto& bounds = made.attributes[0].second.bounds;
        EXPECT_EQ(bounds->first, (Json{double{box.min.x}, double{box.min.y}, double{box.min.z}})) << seed;
        EXPECT_EQ(bounds->second, (Json{double{box.max.x}, double{box.max.y}, double{box.max.z}})) << seed;
        EXPECT_EQ(made.indices.count, 3 * decoded.triangles.size());
        EXPECT_EQ(made.indices.bounds->first, Json::array({0}));
        EXPECT_EQ(made.indices.bounds->second, Json::array({decoded.positions.size() - 1}));
        if (!declares_bounds) continue;
        const std::vector<double>& places = decoded.attributes[0].values;
        const auto& of_places = *made.attributes[1].second.bounds;
        EXPECT_EQ(of_places.second[1].get<double>(), [&] {
          double most = places[1];
          for (size_t i = 1; i < places.size(); i += 2) most = std::max(most, places[i]);
          return most;
        }());
      }
}

}  // namespace
}  // namespace papilio::proto::gltf
