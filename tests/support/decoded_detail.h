#pragma once

#include "papilio/detail.h"

namespace papilio::test {

/// Returns the triangles of decode_detail().
[[nodiscard]] inline TriangleMesh decoded_triangles(const DetailBase& base, std::span<const DetailStream> levels,
                                                    uint64_t face_limit = face_count_limit,
                                                    const std::function<bool()>& cancelled = {}) {
  return decode_detail(base, levels, face_limit, cancelled).triangles();
}

}  // namespace papilio::test
