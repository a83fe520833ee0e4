#include "proto/gltf/scene_mesh.h"

#include <algorithm>
#include <utility>

#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

/// Returns a mesh's surface; nothing if no triangle has an area.
std::optional<Surface> surface_of(const MeshGeometry& geometry, uint32_t number) {
  try {
    return join_primitives(geometry);
  } catch (const Error& error) {
    if (error.fault() == Fault::no_faces) return std::nullopt;
    throw Problem(Problem(error).code(), place("meshes", number) + ": " + error.what());
  }
}

/// Returns whether faces may be visible from behind: the mesh is not closed.
bool is_open(const Mesh& mesh) {
  return std::ranges::any_of(mesh.topology.twin, [](uint32_t twin) { return twin == none; });
}

/// Returns whether any of a mesh's materials is two-sided.
bool is_two_sided(const Json& document, uint32_t number) {
  const std::string where = place("meshes", number);
  const Json& primitives = array_of(element_of(document, "meshes", number, where), "primitives");
  return std::ranges::any_of(primitives, [&](const Json& primitive) {
    const auto material = index_member(primitive, "material", where);
    if (!material) return false;
    const Json* sides = find_member(element_of(document, "materials", *material, where), "doubleSided", where);
    return sides != nullptr && sides->is_boolean() && sides->get<bool>();
  });
}

}  // namespace

double SceneMesh::scale() const {
  double largest = 0;
  for (const auto& of_showing : maps)
    for (const Affine& map : of_showing) largest = std::max(largest, largest_scale(map));
  return largest;
}

SceneMeshes read_meshes(Views& views, const Limits& limits) {
  const Scene scene = read_scene(views);
  Allowance allowance(limits);
  SceneMeshes out;
  for (uint32_t m = 0; m < scene.instances.size(); ++m) {
    const uint64_t faces_before = allowance.faces;
    MeshGeometry geometry = read_geometry(views, m, allowance);
    if (geometry.primitives.empty()) continue;
    extend_box(out.box, scene, m, geometry);
    auto surface = scene.instances[m].empty() ? std::nullopt : surface_of(geometry, m);
    if (!surface) {
      out.unchanged_faces += faces_before - allowance.faces;
      continue;
    }
    SceneMesh& mesh = out.meshes.emplace_back();
    mesh.number = m;
    mesh.maps = maps_of(scene, m, geometry);
    mesh.geometry = std::move(geometry);
    mesh.surface = std::move(*surface);
    mesh.is_two_sided = is_open(mesh.surface.mesh) && is_two_sided(views.document().json, m);
    mesh.diagonal = bounding_box(mesh.surface.mesh.positions).diagonal();
  }
  if (out.meshes.empty())
    throw Problem(Code::mesh_unusable,
                  "The scene shows no triangles that can be refined. Provide a scene with a mesh of triangles.");
  return out;
}

double tolerance_within_budget(uint64_t max_faces, double scene_diagonal,
                               const std::function<uint64_t(double)>& faces_at) {
  if (faces_at(0) <= max_faces) return 0;
  constexpr int halvings_of_range = 20;  // down to a millionth of the scene
  constexpr int refinements = 3;
  double low = 0;  // tolerance with too many faces
  double high = scene_diagonal;
  for (int i = 0; i < halvings_of_range; ++i) {
    if (faces_at(high / 2) > max_faces) {
      low = high / 2;
      break;
    }
    high /= 2;
  }
  for (int i = 0; i < refinements; ++i) {
    const double middle = (low + high) / 2;
    (faces_at(middle) > max_faces ? low : high) = middle;
  }
  return high;
}

}  // namespace papilio::proto::gltf
