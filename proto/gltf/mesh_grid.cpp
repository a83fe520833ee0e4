#include "proto/gltf/mesh_grid.h"

#include <algorithm>

#include "proto/gltf/draco_primitive.h"
#include "proto/quantization_box.h"

namespace papilio::proto::gltf {
namespace {

bool has_draco(const SceneMesh& mesh, const Json& document, Compression requested) {
  const Json& primitives = document["meshes"][mesh.number]["primitives"];
  return std::ranges::any_of(mesh.geometry.primitives, [&](const TrianglePrimitive& primitive) {
    return becomes_draco(primitives[primitive.number], mesh.geometry.sets[primitive.set], requested);
  });
}

}  // namespace

MeshGrid choose_mesh_grid(const SceneMesh& mesh, const Json& document, const Parameters& parameters,
                          std::optional<Options>& options) {
  MeshGrid grid{.output = parameters.output};
  if (!options || !has_draco(mesh, document, parameters.compression)) return grid;
  // A view's pixels do not decide the grid, as for a mesh outside a scene.
  const bool has_tolerance = parameters.options.tolerance > 0;
  Parameters own = parameters;
  own.options.tolerance = has_tolerance ? options->tolerance : 0;
  const Box box = bounding_box(mesh.surface.mesh.positions);
  grid.output = output_for(own, box);
  grid.error = grid_distance(box, grid.output.position_bits) / mesh.diagonal;
  if (has_tolerance) options->tolerance = tolerance_beside_grid(options->tolerance, grid.error);
  return grid;
}

}  // namespace papilio::proto::gltf
