#pragma once

#include <optional>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Where a line meets a surface.
struct LineHit {
  uint32_t face;
  double offset;  ///< along the line's direction
};

/// Walks from face to face of a mesh, seen along the line, to where the line meets it: it stays on the sheet that it
/// starts on. Nothing where that sheet turns away from `direction` on the way, or ends at a curve.
[[nodiscard]] std::optional<LineHit> walk_to_line(const Mesh& surface, uint32_t start_face, Vec3d point,
                                                  Vec3d direction);

}  // namespace papilio
