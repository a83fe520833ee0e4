#pragma once

#include <random>
#include <string>
#include <vector>

#include "proto/detail/base_coder.h"
#include "proto/detail/packed_writer.h"

namespace papilio::test {

/// A packed model of random residuals, as it was written.
struct PackedFixture {
  EncodedDetail detail;
  std::string base_stream;
  std::string glb;
};

/// Packs a base with so many levels of `bytes_per_level` random bytes each, and as many of its texture coordinates if
/// it has any.
inline PackedFixture packed_fixture(const TriangleMesh& base, size_t levels, size_t bytes_per_level = 40) {
  std::mt19937 random(7);
  PackedFixture made;
  proto::detail::DracoBaseCoder coder(1e-3);
  made.detail.base = {coder.code(base).triangles};
  made.base_stream = coder.stream_of(made.detail.base.triangles);
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
  made.glb = proto::detail::write_packed(made.detail, made.base_stream);
  return made;
}

/// The model again, its levels in so many pieces, with some bounds.
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
  made.glb = proto::detail::write_packed(made.detail, made.base_stream);
  return made;
}

}  // namespace papilio::test
