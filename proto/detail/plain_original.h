#pragma once

#include <optional>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Original as files without levels hold it.
struct PlainOriginal {
  /// Without normals, or with them where readers would not find the same by themselves (with_normals()).
  Mesh mesh;
  NormalStyle normals{};     ///< of the original
  bool has_normals = false;  ///< whether `mesh` has them
  /// Without normals, where they cannot be found on a packed model either: what that is compared with.
  std::optional<Mesh> compared{};
};

/// Takes an original with its edges, and normals if it has any. Readers find normals that are smooth, or split at edges
/// that are sharp by their angle, if they are off by few degrees in the mean. Those of faces need not be found.
[[nodiscard]] PlainOriginal plain_original(Mesh original);

}  // namespace papilio::proto::detail
