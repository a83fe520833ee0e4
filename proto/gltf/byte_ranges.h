#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace papilio::proto::gltf {

/// Half-open range of bytes.
struct ByteRange {
  uint64_t begin = 0, end = 0;
};

/// A range of bytes that is kept, and where it begins afterwards.
struct KeptRange {
  ByteRange old;
  uint64_t begin = 0;
};

/// What is left of a block of bytes.
struct KeptBytes {
  std::vector<KeptRange> ranges;  ///< in ascending order
  uint64_t size = 0;

  /// Returns where a byte of a kept range is afterwards; `offset` itself if it is in none.
  [[nodiscard]] uint64_t moved(uint64_t offset) const;
};

/// Removes from a block of `size` bytes what is in `removed` and not in `live`. What is in neither stays, but for fewer
/// than 16 zeros of padding (`bytes` may be empty: all are padding). Offsets keep their remainder by 16.
[[nodiscard]] KeptBytes keep_bytes(uint64_t size, std::vector<ByteRange> removed, std::vector<ByteRange> live,
                                   std::string_view bytes);

}  // namespace papilio::proto::gltf
