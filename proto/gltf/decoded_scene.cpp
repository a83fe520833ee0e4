#include "proto/gltf/decoded_scene.h"

#include <utility>

#include "proto/detail/find_packed.h"
#include "proto/error_translation.h"
#include "proto/gltf/extension_lists.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/split_instances.h"

namespace papilio::proto::gltf {
namespace {

void add(BuildReport& sum, const BuildReport& more) {
  for (auto member : {&BuildReport::welded_points, &BuildReport::isolated_points, &BuildReport::degenerate_faces,
                      &BuildReport::repeated_faces, &BuildReport::boundary_edges, &BuildReport::non_manifold_edges,
                      &BuildReport::misoriented_edges, &BuildReport::pinched_vertices})
    sum.*member += more.*member;
}

/// Attaches the levels of a packed model to its base, the only mesh of its scene.
void attach_detail(std::string_view bytes, const Limits& limits, DecodedScene& decoded) {
  if (!uses_extension(decoded.document.json, detail_extension)) return;
  auto model = detail::find_packed(bytes, limits);
  if (!model) return;
  SceneMesh& mesh = decoded.scene.meshes.at(0);
  add_packed_values(mesh.geometry, mesh.surface);
  mesh.surface.normals = model->normals;
  detail::attach_levels(mesh.surface.mesh, std::move(*model));
  decoded.is_packed = true;
}

uint64_t bytes_of(const MeshGeometry& geometry) {
  uint64_t bytes = 0;
  for (const VertexSet& set : geometry.sets) bytes += set.count * bytes_of_vertex(set);
  for (const TrianglePrimitive& primitive : geometry.primitives) bytes += primitive.triangles.size() * sizeof(Triangle);
  return bytes;
}

}  // namespace

DecodedScene decode_scene(std::string_view bytes, const Limits& limits, bool splits_instances) {
  DecodedScene decoded;
  decoded.document = read_document(bytes);
  if (splits_instances) split_instances(decoded.document.json);
  Views views(decoded.document);
  translate_errors([&] {
    decoded.scene = read_meshes(views, limits);
    attach_detail(bytes, limits, decoded);
  });
  return decoded;
}

uint64_t DecodedScene::coarse_faces() const {
  uint64_t faces = scene.unchanged_faces;
  for (const SceneMesh& mesh : scene.meshes) faces += mesh.coarse_faces();
  return faces;
}

uint64_t DecodedScene::coarse_vertices() const {
  uint64_t vertices = 0;
  for (const SceneMesh& mesh : scene.meshes) vertices += mesh.surface.mesh.topology.vertex_count;
  return vertices;
}

BuildReport DecodedScene::found() const {
  BuildReport sum;
  for (const SceneMesh& mesh : scene.meshes) add(sum, mesh.surface.found);
  return sum;
}

SharedScene::SharedScene(std::shared_ptr<const std::string> bytes, const Limits& limits, uint64_t byte_budget)
    : bytes_(std::move(bytes)), decoded_(decode_scene(*bytes_, limits)) {
  const auto faces = static_cast<double>(decoded_.coarse_faces());
  for (const SceneMesh& mesh : decoded_.scene.meshes) {
    const double share = static_cast<double>(mesh.coarse_faces()) / faces;
    prepared_.push_back(
        std::make_unique<PreparedMeshes>(static_cast<uint64_t>(share * static_cast<double>(byte_budget))));
  }
}

std::shared_ptr<const PreparedMesh> SharedScene::for_rules_of(size_t mesh, const Options& options) const {
  return prepared_[mesh]->for_rules_of(decoded_.scene.meshes[mesh].surface.mesh, options);
}

uint64_t SharedScene::bytes() const {
  uint64_t bytes = bytes_->size();
  for (size_t m = 0; m < prepared_.size(); ++m) {
    const SceneMesh& mesh = decoded_.scene.meshes[m];
    bytes += bytes_of(mesh.geometry) + proto::bytes_of(mesh.surface.mesh) + prepared_[m]->bytes() +
             mesh.coarse_faces() * (sizeof(Triangle) + sizeof(uint32_t));
  }
  return bytes;
}

}  // namespace papilio::proto::gltf
