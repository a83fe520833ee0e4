#pragma once

#include <functional>
#include <string>
#include <vector>

#include "papilio/mesh.h"
#include "proto/parameters.h"
#include "tests/support/gltf_scene.h"

// Memory of the refinement of a scene, and the sum of its necessary parts.

namespace papilio::test {

/// Gives the first primitive of a mesh normals and texture coordinates; `is_skinned`: joints and weights too.
void dress(GltfScene& scene, const TriangleMesh& mesh, bool is_skinned, size_t number = 0);

/// Declares the lowest and highest numbers of an accessor with a view of its own.
void declare_bounds(GltfScene& scene, size_t accessor);

/// Peak memory in MiB.
struct SceneMemory {
  double taken = 0;    ///< by the refinement, with the input scene
  double allowed = 0;  ///< input scene, output scene and the core's refinement of each mesh in turn
};

/// Measures the refinement of a scene in child processes, which are prepared by `prepare`.
[[nodiscard]] SceneMemory measure_scene(
    const std::string& glb, const proto::QueryFields& fields, const std::function<void()>& prepare = [] {});

/// A scene to measure, and its name.
struct MeasuredScene {
  std::string name;
  std::string glb;
  proto::QueryFields fields;
};

/// Returns a scene for each code path of refinement: of `mesh`, of `small`, and of 20 times `small`.
[[nodiscard]] std::vector<MeasuredScene> measured_scenes(const TriangleMesh& mesh, const TriangleMesh& small);

/// Returns a packed model with two levels of residuals.
[[nodiscard]] MeasuredScene measured_packed_model(const TriangleMesh& base);

}  // namespace papilio::test
