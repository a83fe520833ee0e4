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
#include "core/simd/dispatch.h"
#include "papilio/algorithm_version.h"
#include "papilio/refine.h"
#include "proto/draco_writer.h"
#include "proto/parameters.h"
#include "proto/results_version.h"
#include "server/sha256.h"
#include "tests/support/shapes.h"

// What results were when the versions that caches go by were raised last: none may change without these.

namespace papilio::proto {
namespace {

struct Recorded {
  std::string_view request;
  std::string_view sha256;
};

/// Of the core's results: corners, positions, attributes, stop reason and errors. To record them anew, paste what the
/// test prints, and raise `algorithm_version`.
constexpr int recorded_algorithm_version = 2;
constexpr Recorded core_results[]{
    {"", "52785ba1f06709eced18cf057f1ea02f1fb2d9022fc9f69215ce7591aabe292e"},
    {"levels=0", "df8ae46d08e7f1774df784035ff20df946a8b7a3912c5191e6e2de6a379c4be6"},
    {"levels=3&tension=off", "82fcb55558c64c68d2d984c996db25336633b30aec3e9300bf31139535490f0e"},
    {"tension=sharp", "d6e507ab8c9f5c655ec836a57e2aeec85e6ee11b1789cb8529441fd370242a8c"},
    {"levels=1&tension=off&w=0.05", "a05f719f70793d235a293efc6c7bc609011c0240766d1e7e3c43060ad99d1a97"},
    {"levels=3&flatness=0.9,0.95&growth=2", "690a92a1085ae8e1e38ded310a1527c0de4597b7bfd5dab7217bb93206b29860"},
    {"levels=3&flatness=0.8&crease_angle=40&tension=sharp",
     "42580588f248b057d6d514524efa6d1589b2337a921caa3b87c2d7b67b683e9f"},
    {"levels=3&tolerance=0.002", "83cf9e139e409380b52c81950c87925109b0a8176d92a75f68ad8fceeef412bf"},
    {"levels=4&max_faces=500", "b4482bbd10649ce0756ddfeaa2fc47d4d92adfc95854691768d12470700a1bc7"},
    {"levels=2&scheme=in-place&flatness=0.9", "650a609d85918a4f84c1e9a5995af70fb41bb0a194a118ee3e2ffda47f5431ff"},
    {"levels=2&scheme=in-place&tolerance=0.005&tension=off",
     "f2d58ff339f2f1ef4c1c2c6799be0a47115c83e5b48b2ee69e45361f7a08f051"},
    {"levels=3&view.error_pixels=2", "2b885f961f8d08df1da76243d1bbdc94a82c1a4ef2c6def9e5571a2e44acc26c"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=40&flatness=0.95",
     "eda847f10648238e33e34cddf1f57fc52c68cf07dcd0b4c5cfa945c68ec097df"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=0&view.error_pixels=1&view.lights=1,2,3,-1,0,1",
     "77c97997574ae5ee084a53295bfd6f9bf2c996bc3e14b9f0185b2f061ec6230c"},
    {"levels=3&view.eye=2,3,9&view.edge_pixels=0&view.projection=orthographic&max_faces=400&tolerance=1e-4",
     "30eb22a02f5a8241906995fb5bf224ea961b4f4bb5cac0833f90c55e8384fec2"},
};

/// Of the core's results for fans of 3 to 100 faces, closed and open.
constexpr Recorded fan_results[]{
    {"levels=1", "8eb2e523dafab6d8eb18adfa54f856cf1613b0aec79535e6a32e5acd5699c91a"},
    {"levels=1&tension=off", "65c772b7cd521a5de21f05d27aae5343e93912bf7c31b26a1e7965662e4e9e01"},
    {"levels=1&tension=sharp", "e7e4e9c64de54dfb3dab466f50e397bb2703e2eaaf8ddd75257828308f895cf2"},
    {"levels=2", "00dfa5eafbcdb15b1b86a4af25643226fd520a36201c9c06e573420892a604a8"},
};

/// Of the bytes that the encoder makes of these results, without those that libdraco made. To record them anew, paste
/// what the test prints, and raise `encoding_version`.
constexpr int recorded_encoding_version = 2;
constexpr Recorded encoded_results[]{
    {"", "6a344e443d3a52f8da89d523f42ca04e908f76b80405ca679a91ce93997ea57f"},
    {"levels=1&output.speed=0", "afcec6f92f2c953577d2386895dd50db07a5406e05785836325f4448ff680eea"},
    {"levels=1&output.speed=2", "e75d0e3b15b81159deaf0ed93c010f22550e34a460937d53cc73140829d7634a"},
    {"levels=1&output.speed=5&output.position_bits=8",
     "852832b29037f720cab7660c211c290bc6f2eb81d0de10f37717f6d570a04e03"},
    {"levels=1&output.speed=10&output.position_bits=16",
     "0c56e85da0aa02308f025c233d65ec4ee74b1ed88ccceec08ec8e379567b2378"},
    {"levels=1&output.normals=true", "d8c63d597596e4166b6865a045698d3d0ddcc749f90bc78f4c4cd30dac03bd94"},
    {"levels=3&flatness=0.9,0.95", "4d000a720f7a76c96ff13f5c4e2b20bab0c0d00c9ed900a95dbfdffa21c08f39"},
};

/// Coordinates are moved by sums and products of floats alone: the same on every machine.
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

/// Two vertices over and under a ring, or one over an arc of a third of a turn.
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
  // The lowest byte first, whatever the machine does.
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

/// Of "name=value&name=value".
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

/// Compares, and on a difference says what to do, with the lines to paste.
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

TEST(RecordedResults, OfTheCoreChangeOnlyWithTheAlgorithmVersion) { expect_recorded_core_results(); }

TEST(RecordedResults, OfTheCoreAreTheSameWithoutAvx2) {
  allow_avx2(false);
  expect_recorded_core_results();
  allow_avx2(true);
}

TEST(RecordedResults, EncodedChangeOnlyWithTheEncodingVersion) {
  expect_recorded(encoded_results, recorded_encoding_version, encoding_version, "encoding_version", encoded_result);
}

}  // namespace
}  // namespace papilio::proto
