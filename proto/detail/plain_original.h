#pragma once

#include <optional>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Original in the form of files without levels.
struct PlainOriginal {
  /// Mesh without normals; with normals if readers could not derive them (with_normals()).
  Mesh mesh;
  NormalStyle normals{};     ///< style of the original's normals
  bool has_normals = false;  ///< whether `mesh` has normals
  /// Mesh without normals to compare with packed models, if these cannot reproduce them either.
  std::optional<Mesh> compared{};
};

/// Converts an original with edges, and perhaps normals. Readers can derive smooth normals, and normals split at edges
/// of a sharp angle, if these are off by few degrees on average. Faceted normals are never stored.
[[nodiscard]] PlainOriginal plain_original(Mesh original);

}  // namespace papilio::proto::detail
