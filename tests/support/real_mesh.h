#pragma once

#include <string>

#include "papilio/mesh.h"

namespace papilio::test {

/// A mesh that set-up fetched or made, by its name below $PAPILIO_MESHES ("cgal/elephant.off"). Throws when
/// it is not there: tests on real meshes are never passed over.
[[nodiscard]] TriangleMesh real_mesh(const std::string& name);

}  // namespace papilio::test
