#include "proto/gltf/scene_description.h"

#include <algorithm>
#include <set>

#include "proto/findings.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/scene_mesh.h"

namespace papilio::proto::gltf {
namespace {

bool uses(const Json& document, const char* extension) {
  for (const Json& name : array_of(document, "extensionsUsed"))
    if (is_text(name, extension)) return true;
  return false;
}

std::string compression_of(const Json& document) {
  if (uses(document, draco_extension)) return "draco";
  return uses(document, meshopt_extension) ? "meshopt" : "none";
}

Json triple(Vec3f p) { return {p.x, p.y, p.z}; }

Json mesh_json(const Json& document, const SceneMesh& mesh) {
  const Json& json = document["meshes"][mesh.number];
  Json out{{"number", mesh.number}};
  if (json.contains("name")) out["name"] = text_member(json, "name", place("meshes", mesh.number));
  out["vertices"] = mesh.surface.mesh.topology.vertex_count;
  out["faces"] = mesh.coarse_faces();
  out["primitives"] = mesh.geometry.primitives.size();
  out["nodes"] = mesh.maps.size();
  std::set<std::string> attributes;
  size_t targets = 0;
  for (const VertexSet& set : mesh.geometry.sets) {
    targets = std::max(targets, set.targets.size());
    for (const VertexStream& stream : set.attributes) attributes.insert(stream.semantic);
  }
  out["attributes"] = attributes;
  out["morph_targets"] = targets;
  for (const auto& [name, count] : defects(mesh.surface.found)) out["found"][std::string(name)] = count;
  return out;
}

uint64_t faces_of(const Json& document, const Json& primitive, const std::string& where) {
  const auto mode = triangle_mode(primitive, where);
  if (!mode) return 0;
  auto accessor = index_member(primitive, "indices", where);
  const Json* attributes = find_member(primitive, "attributes", where);
  if (!accessor && attributes != nullptr) accessor = index_member(*attributes, "POSITION", where);
  if (!accessor) return 0;
  const uint64_t corners =
      whole_number(element_of(document, "accessors", *accessor, where), "count", place("accessors", *accessor));
  return mode == PrimitiveMode::triangles ? corners / 3 : corners;
}

}  // namespace

uint64_t declared_faces(std::string_view glb) {
  const Document document = read_document(glb);
  const Json& meshes = array_of(document.json, "meshes");
  uint64_t faces = 0;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const std::string where = place("meshes", m);
    const Json* primitives = find_member(meshes[m], "primitives", where);
    if (primitives == nullptr || !primitives->is_array()) refuse_document(where, "has no primitives");
    for (const Json& primitive : *primitives) faces += faces_of(document.json, primitive, where);
  }
  return faces;
}

std::string describe_scene(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  const SceneMeshes scene = read_meshes(views, limits);
  Json out = Json::object();
  uint64_t vertices = 0;
  uint64_t faces = scene.unchanged_faces;
  Json meshes = Json::array();
  for (const SceneMesh& mesh : scene.meshes) {
    vertices += mesh.surface.mesh.topology.vertex_count;
    faces += mesh.coarse_faces();
    meshes.push_back(mesh_json(document.json, mesh));
  }
  out["vertices"] = vertices;
  out["faces"] = faces;
  for (const char* part : {"scenes", "nodes", "skins", "animations", "cameras", "materials", "textures", "images"})
    out[part] = array_of(document.json, part).size();
  out["compression"] = compression_of(document.json);
  out["box"] = {{"min", triple(scene.box.min)}, {"max", triple(scene.box.max)}, {"diagonal", scene.box.diagonal()}};
  out["meshes"] = std::move(meshes);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace papilio::proto::gltf
