#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "proto/limits.h"

namespace papilio::proto {

/// What a Draco stream says of itself before any of it is decoded.
struct DracoHeader {
  bool edgebreaker = false;  ///< else sequential
  uint32_t faces = 0;
  uint32_t vertices = 0;    ///< encoded vertices (edgebreaker) or points (sequential)
  size_t connectivity = 0;  ///< place of the byte behind the metadata
};

/// Reads the header of a triangle mesh, bitstream 2.2, past its metadata if there is any. The decoder trusts
/// the counts, so nothing may be decoded before they are known to be sane. Source: Draco bitstream
/// specification 2.2, sections 3 to 6. Throws `Problem`: mesh_not_draco, mesh_unsupported (another version, a
/// point cloud), mesh_too_large.
[[nodiscard]] DracoHeader read_draco_header(std::string_view bytes, const Limits& limits);

/// Throws `Problem` mesh_too_large, naming the limit, when there are more than it allows of `what` ("faces"). `advice`
/// says what to do about it.
void require_within(uint64_t count, uint64_t limit, const char* what, const char* advice = "Use a coarser mesh.");

}  // namespace papilio::proto
