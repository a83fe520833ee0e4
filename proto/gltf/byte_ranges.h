#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace papilio::proto::gltf {

/// Half-open range of bytes.
struct ByteRange {
  uint64_t begin = 0, end = 0;
};

/// Range of bytes that is kept, and its new begin.
struct KeptRange {
  ByteRange old;
  uint64_t begin = 0;
};

/// Ranges of a block of bytes that are kept.
struct KeptBytes {
  std::vector<KeptRange> ranges;  ///< kept ranges in ascending order
  uint64_t size = 0;

  /// Returns the new offset of a byte of a kept range; `offset` itself if it is in none.
  [[nodiscard]] uint64_t moved(uint64_t offset) const;
};

/// Removes the bytes in `removed` but not in `live` from a block of `size` bytes. Bytes in neither are kept, except
/// fewer than 16 zeros of padding (if `bytes` is empty, all are padding). Offsets keep their remainder modulo 16.
[[nodiscard]] KeptBytes keep_bytes(uint64_t size, std::vector<ByteRange> removed, std::vector<ByteRange> live,
                                   std::string_view bytes);

}  // namespace papilio::proto::gltf
