#include "server/routes/refined_answer.h"

#include "proto/detail/find_packed.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/gltf/flattening.h"
#include "proto/problem.h"
#include "proto/text.h"
#include "server/accept.h"

namespace papilio::server {

std::string negotiate_refined(const Request& request, bool is_scene) {
  const std::string accept = request.header("Accept");
  const auto type = is_scene ? negotiate(accept, {scene_type, bytes_type, draco_type, multipart_type})
                             : negotiate(accept, {draco_type, bytes_type, multipart_type, scene_type});
  if (!type)
    throw proto::Problem(proto::Code::not_acceptable,
                         "Accept is " + proto::quote(accept) +
                             ", but the answer can only be application/x-draco, model/gltf-binary, "
                             "application/octet-stream or multipart/mixed.");
  return *type;
}

std::string mesh_of_scene(const std::string& glb, const proto::Limits& limits) {
  if (proto::detail::find_packed(glb, limits)) return glb;
  const auto mesh = proto::gltf::find_only_mesh(glb, limits);
  if (!mesh)
    throw proto::Problem(proto::Code::not_acceptable,
                         "The scene has several meshes, or shows one several times, which Draco cannot hold. Accept "
                         "model/gltf-binary.");
  return proto::write_draco_exact(*mesh, mesh->format);
}

std::string scene_of_draco(const std::string& draco) {
  const proto::Limits no_limits{face_count_limit, face_count_limit, face_count_limit};
  return proto::gltf::scene_of_mesh(proto::read_draco(draco, no_limits));
}

Response refined_response(const proto::Statistics& made, const std::string& type) {
  Response response;
  response.content_type = type;
  response.headers = {{"Vary", "Accept"}};
  for (auto& header : proto::statistics_headers(made)) response.headers.push_back(std::move(header));
  return response;
}

}  // namespace papilio::server
