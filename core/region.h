#pragma once

#include <vector>

#include "mesh.h"

namespace papilio {

/// Part of a mesh, as lists, so that work on it costs in proportion to the part.
struct Region {
  List<uint32_t> faces;  ///< in ascending order
  List<uint32_t> edges;  ///< in ascending order; all faces at each of them are among `faces`
};

/// All of the mesh.
[[nodiscard]] Region whole_region(const Topology& mesh);

/// The numbers of what is marked, in ascending order.
[[nodiscard]] List<uint32_t> marked(const List<uint8_t>& marks);

}  // namespace papilio
