#pragma once

#include <optional>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Intersection of a line with a surface.
struct LineHit {
  uint32_t face;
  double offset;  ///< position along the line's direction
};

/// Walks from face to face of a mesh to its intersection with a line, and stays on the sheet of the start. Returns
/// nothing if the sheet turns away from `direction` on the way, or ends at a curve.
[[nodiscard]] std::optional<LineHit> walk_to_line(const Mesh& surface, uint32_t start_face, Vec3d point,
                                                  Vec3d direction);

}  // namespace papilio
