#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iostream>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/trigonometry.h"
#include "papilio/algorithm_version.h"
#include "papilio/refine.h"
#include "proto/draco_writer.h"
#include "proto/parameters.h"
#include "proto/results_version.h"
#include "server/sha256.h"
#include "tests/support/shapes.h"

// Results recorded when the cache versions were last raised. Results may change only with these versions.

namespace papilio::proto {
namespace {

struct Recorded {
  std::string_view request;
  std::string_view sha256;
};

/// Hashes of the core's results: corners, positions, attributes, stop reason and errors. To update, paste the lines
/// that the test prints and raise `algorithm_version`.
constexpr int recorded_algorithm_version = 15;
constexpr Recorded core_results[]{
    {"", "2982611f9fd72602a258f3620709310a3bdc031c588216a7df6d84259076135a"},
    {"levels=0", "dd228a0be228fa3c2646311901f4c9ba63df6386fa93c5d343518242fc79607e"},
    {"levels=3&tension=off", "82fcb55558c64c68d2d984c996db25336633b30aec3e9300bf31139535490f0e"},
    {"tension=sharp", "0b965d7c574cbd85e4de060a69f793558bab68c736649286aeaed9d20c82480f"},
    {"levels=1&tension=off&w=0.05", "a05f719f70793d235a293efc6c7bc609011c0240766d1e7e3c43060ad99d1a97"},
    {"levels=3&flatness=0.9,0.95&growth=2", "3e70c51d70b97ce8bf7e9c02bb2a843af98ba25d3c14e96c5e5584176804d924"},
    {"levels=3&flatness=0.8&crease_angle=40&tension=sharp",
     "2f54486142073141d2db8144f910aab1ee8bc85926478d5277930913b11d1579"},
    {"levels=3&tolerance=0.002", "b32d00fc6b67e6aa914abbed4652627c5ee696ac78e46c6b13fb731eb6bddfbd"},
    {"levels=4&max_faces=500", "d90099f94f6d0ea4f34f03c284974919f1a1ed8b0e2b71695da8e54455f85328"},
    {"levels=2&scheme=in-place&flatness=0.9", "7c48c8380bd3fc678d7ebfc88fb12412c49c7286c9f32cd9f2495c9cd442dba8"},
    {"levels=2&scheme=in-place&tolerance=0.005&tension=off",
     "23e810933fb230f97b57037f73c63b4c8176d0bef1e0284f6aa19640ed2ca15d"},
    {"levels=3&view.error_pixels=2", "78f7f89975e3c81f7361e2ef8c01c085b9d58170b81139cf34d7bb407fdba616"},
    {"levels=3&view.error_pixels=2&view.verify=false",
     "1f3662b5921eccc2acb00bcaf2afad209bb32273741f151b5a166bb70655cf76"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=40&flatness=0.95",
     "830502e693ae503080b9cc1ee33a02134e9358d3e25b11799f809c1d3ca68729"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=0&view.error_pixels=1&view.lights=1,2,3,-1,0,1",
     "09bf8e53bd810e07c807a0b50a8f912e00b07e9f2272e61701a5ab0b4d7d4af5"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=0&view.projection=orthographic&max_faces=400&tolerance=1e-4",
     "a18b6c5c868df18975ff30a5f801298294e32829472f963f862be817f12943ff"},
};

/// Hash of the core's results for closed and open fans of 3 to 100 faces.
constexpr Recorded fan_results[]{
    {"levels=1", "255a322a57123b25d155ab1f7917187d9d0f09f121d22bb04351043b040b4714"},
    {"levels=1&tension=off", "65c772b7cd521a5de21f05d27aae5343e93912bf7c31b26a1e7965662e4e9e01"},
    {"levels=1&tension=sharp", "4d28ce99c3c7e05854f3acc1d8d9658c2e927ce12914a8a246f7cf2477478176"},
    {"levels=2", "13dc4e5a541b1eef37c3cbd90b5a4069bd4e62d29ed05f062926ff1205f3ff25"},
};

/// Hashes of the encoder's bytes for these results, without bytes of libdraco. To update, paste the lines that the test
/// prints and raise `encoding_version`.
constexpr int recorded_encoding_version = 5;
constexpr Recorded encoded_results[]{
    {"", "ac6e1d94078894f7fae9a5eeb3ef1ed5a2f09d2fb79c14fd85c87c6932f40c46"},
    {"levels=1&output.speed=0", "e315e695ee9105825a1b2bce6eb91e96be90a92bc43fcbfc1cc061f5c93978e2"},
    {"levels=1&output.speed=2", "83aa2ab2ae914f95b0a863a6306de4a49519db5b70ad38a2a9f6486328971445"},
    {"levels=1&output.speed=5&output.position_bits=8",
     "81a8ae270a4ddb648022a1e7754a59012daedb98eb69cf5f40257f81f1fa0b64"},
    {"levels=1&output.speed=10&output.position_bits=16",
     "0f079b5603f211d532ffad43d093eb201e008d0de8241fed2f0847466fba4b3c"},
    {"levels=1&output.normals=true", "f973529265293627e724a9ceb3ce419dc17ec51a659b83f545279196298aa327"},
    {"levels=3&flatness=0.9,0.95", "ca173aa5ff86b3c1d524445a4bc1c5fc83809fc77ca98707dc0bac1305b32f19"},
};

/// Moves coordinates by sums and products of floats: bit-identical on all machines.
TriangleMesh jittered(TriangleMesh mesh, uint32_t seed) {
  std::mt19937 random(seed);
  const auto share = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F - 0.5F; };
  for (Vec3f& p : mesh.positions) {
    p.x += 0.2F * share();
    p.y += 0.2F * share();
    p.z += 0.2F * share();
  }
  return mesh;
}

/// Two apexes over a ring, or one apex over an arc of a third of a turn.
TriangleMesh spokes(uint32_t valence, bool is_closed) {
  TriangleMesh mesh;
  const uint32_t points = is_closed ? valence : valence + 1;
  for (uint32_t j = 0; j < points; ++j) {
    const SineCosine at = sine_and_cosine_of_turn(j, is_closed ? valence : uint64_t{3} * valence);
    mesh.positions.push_back(to_float({at.cosine, at.sine, 0}));
  }
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  for (uint32_t j = 0; j < valence; ++j) {
    const uint32_t next = (j + 1) % points;
    mesh.triangles.push_back({j, next, points});
    if (is_closed) mesh.triangles.push_back({next, j, points + 1});
  }
  return mesh;
}

/// Texture coordinates, with a seam between the first half of the faces and the second.
TriangleMesh charted() {
  TriangleMesh mesh = jittered(test::grid(5, 4), 3);
  const auto points = static_cast<uint32_t>(mesh.positions.size());
  Attribute coordinates{.components = 2, .values = {}};
  for (uint32_t i = 0; i < 2 * points; ++i) {
    const Vec3f p = mesh.positions[i % points];
    if (i >= points) mesh.positions.push_back(p);
    coordinates.values.insert(coordinates.values.end(), {p.x, i < points ? p.y : p.y + 1});
  }
  for (size_t f = mesh.triangles.size() / 2; f < mesh.triangles.size(); ++f)
    for (uint32_t& point : mesh.triangles[f]) point += points;
  mesh.attributes.push_back(coordinates);
  return mesh;
}

std::vector<TriangleMesh> meshes() {
  const TriangleMesh book{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0}, {1, 0, 2}, {0, 1, 1}, {-1, -1, 1}},
                          {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}, {1, 0, 6}, {2, 1, 6}}};
  std::vector<TriangleMesh> all{test::box({2, 2, 3}, {1, 2, 3}), jittered(test::icosahedron(), 1),
                                jittered(test::grid(5, 4), 2), charted(), book};
  for (const uint32_t valence : {7, 12, 33, 40, 59, 60}) all.push_back(spokes(valence, true));
  for (const uint32_t valence : {2, 5, 33}) all.push_back(spokes(valence, false));
  return all;
}

std::vector<TriangleMesh> fans() {
  std::vector<TriangleMesh> all;
  for (uint32_t valence = 3; valence <= 100; ++valence)
    for (const bool is_closed : {true, false}) all.push_back(jittered(spokes(valence, is_closed), valence));
  return all;
}

template <class Number>
void append(std::string& bytes, Number number) {
  // Little endian on all machines.
  uint64_t bits = 0;
  if constexpr (std::is_floating_point_v<Number>)
    bits = std::bit_cast<uint64_t>(static_cast<double>(number));
  else
    bits = static_cast<uint64_t>(number);
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(bits >> (8 * i) & 255U));
}

std::string bytes_of(const Result& result) {
  std::string bytes;
  for (uint32_t v : result.mesh.topology.origin) append(bytes, v);
  for (const Vec3f& p : result.mesh.positions)
    for (const float c : {p.x, p.y, p.z}) append(bytes, c);
  for (uint32_t p : result.mesh.attributes.point) append(bytes, p);
  for (const Attribute& attribute : result.mesh.attributes.attributes)
    for (const double value : attribute.values) append(bytes, value);
  append(bytes, result.levels);
  append(bytes, static_cast<int>(result.stop_reason));
  append(bytes, result.error);
  append(bytes, result.error_pixels);
  return bytes;
}

/// Parses "name=value&name=value".
Parameters parameters_of(std::string_view request) {
  QueryFields fields;
  while (!request.empty()) {
    const std::string_view field = request.substr(0, request.find('&'));
    request.remove_prefix(std::min(request.size(), field.size() + 1));
    fields.emplace_back(field.substr(0, field.find('=')), field.substr(field.find('=') + 1));
  }
  return parse_query(fields);
}

std::string core_result(const std::vector<TriangleMesh>& meshes, std::string_view request) {
  std::string bytes;
  for (const TriangleMesh& triangles : meshes) {
    const Mesh mesh = build_mesh(triangles);
    bytes += bytes_of(refine(mesh, options_for(parameters_of(request), bounding_box(mesh.positions))));
  }
  return server::sha256(bytes);
}

std::string encoded_result(std::string_view request) {
  const Parameters parameters = parameters_of(request);
  std::string bytes;
  for (const TriangleMesh& triangles : meshes()) {
    const Mesh coarse = build_mesh(triangles);
    MeshFormat format;
    if (!triangles.attributes.empty()) format.attributes.push_back({.kind = AttributeKind::tex_coord, .id = 1});
    bytes += write_draco(refine(coarse, parameters.options).mesh, quantization_box(coarse.positions), parameters.output,
                         attribute_encoding(coarse, format));
  }
  return server::sha256(bytes);
}

/// Compares hashes. On a difference, prints the instructions and the lines to paste.
template <class ResultOf>
void expect_recorded(std::span<const Recorded> recorded, int recorded_version, int version, const char* name,
                     const ResultOf& result_of) {
  std::string lines;
  bool is_same = true;
  for (const auto& [request, expected] : recorded) {
    const std::string found = result_of(request);
    is_same &= found == expected;
    if (found != expected) std::cout << "changed: \"" << request << "\"\n";
    lines += "    {\"" + std::string(request) + "\", \"" + found + "\"},\n";
  }
  const int next = std::max(version, recorded_version + 1);
  EXPECT_TRUE(is_same) << "Results changed: raise " << name << " to " << next << ", set recorded_" << name << " = "
                       << next << ", and record the new hashes:\n"
                       << lines;
  EXPECT_EQ(recorded_version, version) << "The hashes were recorded at another " << name << ".";
}

void expect_recorded_core_results() {
  const std::vector<TriangleMesh> some_meshes = meshes();
  const std::vector<TriangleMesh> some_fans = fans();
  const auto of = [](const std::vector<TriangleMesh>& meshes) {
    return [&meshes](std::string_view request) { return core_result(meshes, request); };
  };
  expect_recorded(core_results, recorded_algorithm_version, algorithm_version, "algorithm_version", of(some_meshes));
  expect_recorded(fan_results, recorded_algorithm_version, algorithm_version, "algorithm_version", of(some_fans));
}

TEST(RecordedResults, CoreResultsChangeOnlyWithTheAlgorithmVersion) { expect_recorded_core_results(); }

TEST(RecordedResults, EncodedResultsChangeOnlyWithTheEncodingVersion) {
  expect_recorded(encoded_results, recorded_encoding_version, encoding_version, "encoding_version", encoded_result);
}

}  // namespace
}  // namespace papilio::proto
