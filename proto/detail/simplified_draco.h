#pragma once

#include <optional>
#include <string>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// A simplified mesh without levels, for comparison and where it is smaller.
struct SimplifiedDraco {
  std::string glb{};
  uint64_t bytes = 0;  ///< of `glb`
  size_t faces = 0;
  int position_bits = 0;
  DetailReach reach{};  ///< from samples, the largest from vertices, too
};

/// Simplifies a surface to the wanted distances, and writes it as Draco in a .glb file. Nothing where no file was found
/// that reaches them. `normals`: style of those that readers are to find. Throws `Problem` and `Error`.
[[nodiscard]] std::optional<SimplifiedDraco> write_simplified_draco(const TriangleMesh& original,
                                                                    const SimplifyOptions& options,
                                                                    NormalStyle normals = {});

}  // namespace papilio::proto::detail
