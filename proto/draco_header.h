#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "proto/limits.h"

namespace papilio::proto {

/// Header of a Draco stream.
struct DracoHeader {
  bool edgebreaker = false;  ///< else sequential
  uint32_t faces = 0;
  uint32_t vertices = 0;    ///< encoded vertices (edgebreaker) or points (sequential)
  size_t connectivity = 0;  ///< offset of the first byte after the metadata
};

/// Reads the header of a triangle mesh of bitstream 2.2 and skips its metadata. libdraco trusts the counts, so they are
/// checked before anything is decoded. Source: Draco bitstream specification 2.2, sections 3 to 6. Throws `Problem`:
/// mesh_not_draco, mesh_unsupported (another version, a point cloud), mesh_too_large.
[[nodiscard]] DracoHeader read_draco_header(std::string_view bytes, const Limits& limits);

/// Throws `Problem` mesh_too_large if `count` exceeds `limit`. `what`: the counted thing, such as "faces". `advice`: a
/// sentence for the user.
void require_within(uint64_t count, uint64_t limit, const char* what, const char* advice = "Use a coarser mesh.");

}  // namespace papilio::proto
