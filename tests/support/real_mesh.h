#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// A mesh that set-up fetched or made, by its name below $PAPILIO_MESHES ("cgal/elephant.off"). Throws when
/// it is not there: tests on real meshes are never passed over.
[[nodiscard]] TriangleMesh real_mesh(const std::string& name);

/// Every file of libcgal-demo's meshes, sorted; some cannot be read as triangles. Throws like `real_mesh`.
[[nodiscard]] std::vector<std::filesystem::path> cgal_mesh_files();

}  // namespace papilio::test
