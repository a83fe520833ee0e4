#include "tests/support/crowded_meshes.h"

#include <draco/compression/bit_coders/rans_bit_encoder.h>
#include <draco/compression/mesh/mesh_edgebreaker_shared.h>
#include <draco/core/encoder_buffer.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace papilio::test {
namespace {

/// Returns the i-th of n points on a circle about the z axis.
Vec3f on_circle(double i, uint32_t n) {
  const double angle = 2 * std::numbers::pi * i / n;
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
}

}  // namespace

TriangleMesh faces_at_one_edge(uint32_t faces) {
  TriangleMesh mesh{{{0, 0, -1}, {0, 0, 1}}, {}};
  for (uint32_t f = 0; f < faces; ++f) {
    mesh.positions.push_back(on_circle(f, faces));
    mesh.triangles.push_back({f % 2, 1 - f % 2, 2 + f});
  }
  return mesh;
}

TriangleMesh triangles_at_one_vertex(uint32_t faces) {
  TriangleMesh mesh{{{0, 0, 0}}, {}};
  for (uint32_t f = 0; f < faces; ++f) {
    mesh.positions.push_back(on_circle(f, faces));
    mesh.positions.push_back(on_circle(f + 0.5, faces));
    mesh.triangles.push_back({0, 1 + 2 * f, 2 + 2 * f});
  }
  return mesh;
}

TriangleMesh shuffled_cone(uint32_t faces) {
  TriangleMesh mesh{{{0, 0, 0.5F}}, {}};
  for (uint32_t f = 0; f < faces; ++f) {
    mesh.positions.push_back(on_circle(f, faces));
    mesh.triangles.push_back({0, 1 + f, 1 + (f + 1) % faces});
  }
  std::ranges::shuffle(mesh.triangles, std::mt19937(3));
  return mesh;
}

std::string merging_stream(uint32_t triangles) {
  using draco::EncodeVarint;
  std::vector<draco::EdgebreakerTopologyBitPattern> symbols(triangles, draco::TOPOLOGY_E);
  for (uint32_t i = 1; i < triangles; ++i)
    symbols.insert(symbols.end(), {draco::TOPOLOGY_S, draco::TOPOLOGY_C, draco::TOPOLOGY_C});
  const uint32_t vertices = 2 * triangles + 1;
  draco::EncoderBuffer out;
  out.Encode("DRACO", 5);
  for (const uint8_t byte : {2, 2, 1, 1, 0, 0, 0}) out.Encode(byte);  // no metadata, symbols as bits
  EncodeVarint<uint32_t>(vertices, &out);
  EncodeVarint(static_cast<uint32_t>(symbols.size()), &out);
  out.Encode(uint8_t{0});
  EncodeVarint(static_cast<uint32_t>(symbols.size()), &out);
  EncodeVarint<uint32_t>(triangles - 1, &out);
  EncodeVarint<uint32_t>(0, &out);  // events
  out.StartBitEncoding(static_cast<int64_t>(3 * symbols.size()), true);
  for (const auto symbol : symbols)
    out.EncodeLeastSignificantBits32(draco::edge_breaker_topology_bit_pattern_length[symbol], symbol);
  out.EndBitEncoding();
  draco::RAnsBitEncoder starts;
  starts.StartEncoding();
  starts.EncodeBit(false);
  starts.EndEncoding(&out);
  for (const uint8_t byte : {1, 255, 0, 0, 1, 0, 9, 3, 0, 0, 0}) out.Encode(byte);  // positions, raw
  for (uint32_t v = 0; v < vertices; ++v) {
    const auto x = static_cast<float>(v);
    for (const float c : {x, x * x, 0.0F}) out.Encode(c);
  }
  return {out.data(), out.size()};
}

}  // namespace papilio::test
