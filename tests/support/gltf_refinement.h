#pragma once

#include <string>

#include "proto/gltf/scene_refinement.h"
#include "tests/support/gltf_scene.h"

namespace papilio::test {

/// Refines the scene with these parameters.
inline proto::EncodedLevel refined(const std::string& glb, const proto::QueryFields& fields,
                                   const proto::Limits& limits = {}) {
  return proto::gltf::SceneRefinement(glb, proto::parse_query(fields), limits).run();
}

[[nodiscard]] inline proto::gltf::MeshGeometry geometry_of(const std::string& glb, uint32_t mesh = 0) {
  const proto::gltf::Document document = proto::gltf::read_document(glb);
  proto::gltf::Views views(document);
  proto::gltf::Allowance allowance({});
  return proto::gltf::read_geometry(views, mesh, allowance);
}

[[nodiscard]] inline size_t faces_of(const std::string& glb, uint32_t mesh = 0) {
  size_t faces = 0;
  for (const auto& primitive : geometry_of(glb, mesh).primitives) faces += primitive.triangles.size();
  return faces;
}

}  // namespace papilio::test
