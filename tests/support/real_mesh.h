#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// Returns a mesh that set-up fetched or made, by its name below $PAPILIO_MESHES ("cgal/elephant.off"). Throws if
/// it is missing: tests on real meshes are never skipped.
[[nodiscard]] TriangleMesh real_mesh(const std::string& name);

/// Returns all files of libcgal-demo's meshes, sorted; some cannot be read as triangles. Throws like `real_mesh`.
[[nodiscard]] std::vector<std::filesystem::path> cgal_mesh_files();

}  // namespace papilio::test
