#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace papilio::test {

/// Decodes a stream: for each face, the bits of the positions and attribute values at its three corners. Faces are
/// sorted, and each starts at its least corner, so that equal meshes give equal lists in any order.
[[nodiscard]] std::vector<std::vector<uint64_t>> faces_of(std::string_view draco);

}  // namespace papilio::test
