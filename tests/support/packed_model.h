#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "proto/detail/base_coder.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/packed_writer.h"
#include "proto/gltf/container.h"
#include "proto/gltf/material_attribute.h"
#include "proto/problem.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

namespace papilio::test {

/// A packed model of random residuals, and its file.
struct PackedFixture {
  EncodedDetail detail;
  std::string base_stream;
  std::string glb;
};

/// Packs a base with levels of `bytes_per_level` random bytes each, and as many bytes of texture coordinates if the
/// base has any.
inline PackedFixture packed_fixture(const TriangleMesh& base, size_t levels, size_t bytes_per_level = 40) {
  std::mt19937 random(7);
  PackedFixture made;
  proto::detail::DracoBaseCoder coder(1e-3);
  made.detail.base = {coder.code(base).triangles};
  made.base_stream = coder.streams_of(made.detail.base.triangles).at(0);
  made.detail.reach.push_back({0.01, 0.0625});
  for (size_t l = 0; l < levels; ++l) {
    DetailStream& stream = made.detail.levels.emplace_back();
    stream.step = 0.1F / static_cast<float>(l + 1);
    const auto add_bytes = [&](std::vector<uint8_t>& bytes) {
      for (size_t i = 0; i < bytes_per_level; ++i) bytes.push_back(static_cast<uint8_t>(random()));
    };
    add_bytes(stream.bytes);
    if (!base.attributes.empty()) {
      stream.texcoords.step = 0.01F;
      add_bytes(stream.texcoords.bytes);
    }
    made.detail.reach.push_back({0.00123456 / static_cast<double>(l + 1), 0.02 / static_cast<double>(l + 1)});
  }
  made.glb = proto::detail::write_packed(made.detail, {made.base_stream});
  return made;
}

/// A packed model of two parts, and its file.
struct PartedFixture {
  EncodedDetail detail;
  std::vector<std::string> base_streams{};
  std::string glb{};
};

/// Packs an octahedron, with a material for each half, and two levels of random bytes.
inline PartedFixture parted_fixture() {
  proto::gltf::MaterialMesh shape{.mesh = {}};
  static_cast<TriangleMesh&>(shape.mesh) = octahedron();
  shape.materials.materials = {{.name = "upper"}, {.name = "lower"}};
  for (const auto& [a, b, c] : shape.mesh.triangles) {
    const auto height = [&](uint32_t point) { return shape.mesh.positions[point].z; };
    shape.materials.of_triangle.push_back(height(a) + height(b) + height(c) > 0 ? 0 : 1);
  }
  proto::gltf::add_material_attribute(shape);
  proto::detail::DracoBaseCoder coder(1e-3);
  PartedFixture made{.detail = packed_fixture(octahedron(), 2).detail};
  made.detail.base.triangles = coder.code(shape.mesh).triangles;
  made.base_streams = coder.streams_of(made.detail.base.triangles);
  made.glb = proto::detail::write_packed(made.detail, made.base_streams, shape.materials);
  return made;
}

/// Returns the file with its JSON changed.
inline std::string with_json(const std::string& glb, const std::function<void(GltfScene::Json&)>& change) {
  GltfScene::Json json = json_of_glb(glb);
  change(json);
  std::vector<proto::gltf::Piece> pieces;
  pieces.push_back({{}, binary_of_glb(glb)});
  return proto::gltf::write_glb(json.dump(), std::move(pieces), {});
}

/// Returns the code with which the file with changed JSON is refused; "read" if it is read.
inline std::string refusal_of(const std::string& glb, const std::function<void(GltfScene::Json&)>& change) {
  try {
    (void)proto::detail::read_packed(with_json(glb, change));
    return "read";
  } catch (const proto::Problem& problem) {
    return std::string(proto::problem_kind(problem.code()).name);
  }
}

/// Returns the model with its levels in this many pieces, with some bounds.
inline PackedFixture in_pieces(PackedFixture made, const std::vector<uint32_t>& counts) {
  for (size_t l = 0; l < counts.size(); ++l) {
    DetailStream& level = made.detail.levels[l];
    const auto bytes = static_cast<uint32_t>(level.bytes.size());
    const auto texcoord_bytes = static_cast<uint32_t>(level.texcoords.bytes.size());
    for (uint32_t p = 0; counts[l] > 1 && p < counts[l]; ++p) {
      const auto share = [&](uint32_t all) { return all * (p + 1) / counts[l] - all * p / counts[l]; };
      const auto number = static_cast<float>(p + 1);
      level.pieces.push_back({.bytes = share(bytes),
                              .texcoord_bytes = share(texcoord_bytes),
                              .bounds = {.largest_move = 0.01F * number,
                                         .centre = {number, -number, 0.5F},
                                         .radius = 0.1F * number,
                                         .axis = {0, 0.6F, -0.8F},
                                         .least_cosine = 1 / number - 1}});
    }
  }
  made.glb = proto::detail::write_packed(made.detail, {made.base_stream});
  return made;
}

}  // namespace papilio::test
