#pragma once

#include <optional>
#include <string>

#include "papilio/mesh.h"

namespace papilio::client {

/// Returns what is wrong with the first triangle that has an index out of range; nothing if there is none.
[[nodiscard]] std::optional<std::string> find_broken(const TriangleMesh& mesh);

/// Returns what is wrong with a mesh that was read: no triangles, or a broken one; nothing if it is sound.
[[nodiscard]] std::optional<std::string> find_fault(const TriangleMesh& mesh);

}  // namespace papilio::client
