#pragma once

#include <vector>

#include "mesh.h"
#include "view.h"

namespace papilio {

/// How much a deviation at the edge matters to a picture lit by the view's lights: more where the shading changes over
/// the edge, most on the silhouette. `normals` [F]. 1 is an average edge.
[[nodiscard]] double light_weight(const Mesh& mesh, const std::vector<Vec3f>& normals, uint32_t edge, const View& view,
                                  const Camera& camera);

}  // namespace papilio
