#include "server/routes/refined_answer.h"

#include "proto/problem.h"
#include "proto/text.h"
#include "server/accept.h"

namespace papilio::server {

std::string negotiate_stored(const Request& request, bool is_scene) {
  const std::string accept = request.header("Accept");
  const auto type = is_scene ? negotiate(accept, {scene_type, bytes_type, multipart_type})
                             : negotiate(accept, {draco_type, bytes_type, multipart_type});
  if (!type)
    throw proto::Problem(proto::Code::not_acceptable, "Accept is " + proto::quote(accept) +
                                                          ", but the answer can only be " +
                                                          (is_scene ? "model/gltf-binary" : "application/x-draco") +
                                                          ", application/octet-stream or multipart/mixed.");
  return *type;
}

std::string negotiate_posted(const Request& request, bool is_scene) {
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

Response refined_response(const proto::Statistics& made, const std::string& type) {
  Response response;
  response.content_type = type;
  response.headers = {{"Vary", "Accept"}};
  for (auto& header : proto::statistics_headers(made)) response.headers.push_back(std::move(header));
  return response;
}

}  // namespace papilio::server
