#pragma once

#include <random>
#include <string>

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

}  // namespace papilio::test
