#include "proto/gltf/refined_geometry.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/gltf/draco_primitive.h"
#include "proto/gltf/interpolation.h"
#include "proto/gltf/morph_targets.h"

namespace papilio::proto::gltf {

namespace {

/// Replaces interpolated values of vertices by the values of detail levels.
void put_values(const RefinedVertices& vertices, const Attribute& given, std::string_view semantic, VertexSet& set) {
  const auto stream = std::ranges::find(set.attributes, semantic, &VertexStream::semantic);
  if (stream == set.attributes.end()) return;
  for (size_t i = 0; i < vertices.size(); ++i)
    for (uint32_t c = 0; c < given.components; ++c)
      stream->elements.set_number(i, c, given.values[size_t{given.components} * vertices.numbers[i] + c]);
}

}  // namespace

NewGeometry refined_geometry(const SceneMesh& mesh, Result result, bool adds_normals,
                             const std::function<void()>& poll) {
  Mesh refined = std::move(result.mesh);
  const bool renews_normals = mesh.surface.has_normals && result.levels > 0;
  std::optional<size_t> normals;
  if (mesh.surface.has_normals) {
    normals = 1;
    if (renews_normals) renew_normals(refined, *normals);
  } else if (adds_normals) {
    normals = refined.attributes.attributes.size();
    if (!add_detail_normals(refined, mesh.surface.normals)) add_normals(refined);
  }
  poll();
  const std::vector<RefinedTarget> targets =
      refine_targets(mesh.geometry, mesh.surface, refined, renews_normals ? normals : std::nullopt);
  poll();
  const RefinedPoints points(mesh.geometry, mesh.surface, refined, normals);
  refined.topology = {};  // large, and no longer needed
  RefinedPrimitives parts = part_primitives(mesh.geometry, points, refined);
  poll();
  const KeptFormats kept = find_kept_formats(mesh.geometry, parts.sets, targets);
  NewGeometry made{mesh.number, {}, quantization_box(mesh.surface.mesh.positions)};
  for (size_t s = 0; s < mesh.geometry.sets.size(); ++s) {
    const RefinedVertices vertices = std::exchange(parts.sets[s], {});
    made.geometry.sets.push_back(interpolate_vertices(mesh.geometry.sets[s], vertices, targets, kept, adds_normals));
    const std::vector<Attribute>& attributes = refined.attributes.attributes;
    if (const auto texcoords = mesh.surface.texcoords)
      put_values(vertices, attributes[*texcoords], "TEXCOORD_0", made.geometry.sets.back());
    if (const auto colours = mesh.surface.colours)
      put_values(vertices, attributes[*colours], "COLOR_0", made.geometry.sets.back());
  }
  for (size_t p = 0; p < mesh.geometry.primitives.size(); ++p)
    if (!parts.triangles[p].empty())
      made.geometry.primitives.push_back(
          {mesh.geometry.primitives[p].number, mesh.geometry.primitives[p].set, std::move(parts.triangles[p])});
  return made;
}

NewGeometry unrefined_geometry(const SceneMesh& mesh) {
  return {mesh.number, mesh.geometry, quantization_box(mesh.surface.mesh.positions)};
}

uint64_t parting_bytes(const SceneMesh& mesh, const Mesh& refined, bool is_compressed) {
  constexpr uint64_t numbers = 16;  // bytes for the place and the new number of a point
  constexpr uint64_t copies = 2;    // copies of values, before and during compression
  uint64_t vertex = 0;
  for (const VertexSet& set : mesh.geometry.sets) vertex = std::max(vertex, bytes_of_vertex(set));
  const uint64_t points = refined.attributes.point_count;
  const uint64_t parts = points * vertex + refined.topology.face_count() * sizeof(Triangle);
  return points * numbers + (is_compressed ? copies * parts : 0);
}

OutputBytes output_bytes(const SceneMesh& mesh, const Json& primitives, Compression requested) {
  constexpr uint64_t bytes_of_parting = 40;  // bytes for the numbers of a point, and its place in their order
  OutputBytes bytes{.face = 36, .point = bytes_of_parting};
  for (const VertexSet& set : mesh.geometry.sets)
    bytes.point = std::max(bytes.point, 2 * bytes_of_vertex(set) + bytes_of_parting);
  bytes.point += mesh.surface.target_count * 2 * sizeof(Vec3d);
  for (const TrianglePrimitive& primitive : mesh.geometry.primitives) {
    const VertexSet& set = mesh.geometry.sets[primitive.set];
    if (!becomes_draco(primitives[primitive.number], set, requested)) continue;
    const OutputBytes draco = draco_bytes(set);
    bytes = {.face = std::max(bytes.face, draco.face), .point = std::max(bytes.point, draco.point)};
  }
  return bytes;
}

}  // namespace papilio::proto::gltf
