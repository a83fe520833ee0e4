#pragma once

#include <optional>
#include <string>

#include "papilio/detail.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// File of a simplified mesh without levels.
struct SimplifiedDraco {
  std::string glb{};
  uint64_t bytes = 0;  ///< length of `glb`
  size_t faces = 0;
  int position_bits = 0;
  DetailReach reach{};  ///< distances from samples; the largest also from vertices
};

/// Simplifies a surface within the given distances, and writes it as Draco in a .glb file. Returns nothing if no file
/// within them is found. `normals`: style of the normals that readers derive. `materials`: the material of all faces,
/// or none. Throws `Problem` and `Error`.
[[nodiscard]] std::optional<SimplifiedDraco> write_simplified_draco(const TriangleMesh& original,
                                                                    const SimplifyOptions& options,
                                                                    NormalStyle normals = {},
                                                                    const gltf::Materials& materials = {});

}  // namespace papilio::proto::detail
