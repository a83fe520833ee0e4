#include "server/routes/refine_route.h"

#include <memory>

#include "proto/gltf/container.h"
#include "proto/gltf/scene_refinement.h"
#include "proto/parameters.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "proto/text.h"
#include "server/routes/refined_answer.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Parameters;
using proto::Problem;
using proto::Refinement;

struct Order {
  std::string mesh;
  Parameters parameters;
};

Order read_form(Request& request) {
  if (!request.query().empty())
    throw Problem(Code::bad_request,
                  "With a form, parameters belong into its part \"params\" (JSON), not into the query.");
  Body body = request.read_body();
  Order order;
  bool has_mesh = false;
  bool has_parameters = false;
  for (FormPart& part : body.parts) {
    bool& seen = part.name == "mesh" ? has_mesh : has_parameters;
    if (part.name != "mesh" && part.name != "params")
      throw Problem(Code::bad_request, "The form has a part " + proto::quote(part.name) +
                                           "; its parts are \"mesh\" (Draco or .glb) and \"params\" (JSON).");
    if (seen) throw Problem(Code::bad_request, "The form has two parts " + proto::quote(part.name) + "; send one.");
    seen = true;
    if (part.name == "mesh")
      order.mesh = std::move(part.bytes);
    else
      order.parameters = proto::parse_json(part.bytes);
  }
  if (!has_mesh) throw Problem(Code::bad_request, "The form has no part \"mesh\". Add one: curl -F mesh=@in.drc ...");
  return order;
}

Order read_order(Request& request) {
  const std::string type = request.content_type();
  if (type == "multipart/form-data") return read_form(request);
  if (!type.empty() && type != draco_type && type != bytes_type && type != scene_type)
    throw Problem(Code::unsupported_media_type,
                  "Bodies of type " + proto::quote(type) +
                      " are not read here. Send a Draco file with -H 'Content-Type: application/x-draco', a .glb file "
                      "with model/gltf-binary, or a form with parts mesh and params.");
  Parameters parameters = proto::parse_query(request.query());
  return {request.read_body().bytes, std::move(parameters)};
}

Response unstored(Response response, std::string body) {
  response.body = std::move(body);
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

Response refined_scene(Engine& engine, Request& request, Order order, const std::string& type) {
  const auto gone = [&] { return request.client_gone(); };
  auto slot = engine.enter(request, engine.work_of_scene(order.mesh, order.parameters.options), gone);
  const auto refinement = std::make_shared<proto::gltf::SceneRefinement>(
      std::make_shared<const std::string>(std::move(order.mesh)), order.parameters, engine.limits());
  if (type == multipart_type)
    return level_stream(engine, request, std::move(slot), scene_type, run_of(engine, refinement));
  proto::EncodedLevel made = engine.run(*refinement, {.on_level = {}, .cancelled = gone}, *slot);
  return unstored(refined_response(made.statistics, type), std::move(made.bytes));
}

}  // namespace

Response refine_route(Engine& engine, Request& request) {
  (void)negotiate_refined(request, false);
  engine.admission().refuse_when_full(request.client());
  Order order = read_order(request);
  const bool is_scene = request.content_type() == scene_type || proto::gltf::is_glb(order.mesh);
  const std::string type = negotiate_refined(request, is_scene);
  if (is_scene && type != draco_type) return refined_scene(engine, request, std::move(order), type);
  const auto gone = [&] { return request.client_gone(); };
  auto slot = engine.enter(request,
                           is_scene ? engine.work_of_scene(order.mesh, order.parameters.options)
                                    : engine.work_of(order.mesh, order.parameters.options),
                           gone);
  if (is_scene) order.mesh = mesh_of_scene(order.mesh, engine.limits());
  const auto refinement = std::make_shared<Refinement>(order.mesh, order.parameters, engine.limits());
  if (type == multipart_type)
    return level_stream(engine, request, std::move(slot), draco_type, run_of(engine, refinement));
  proto::EncodedLevel made = engine.run(*refinement, {.cancelled = gone}, *slot);
  if (type == scene_type) made.bytes = scene_of_draco(made.bytes);
  return unstored(refined_response(made.statistics, type), std::move(made.bytes));
}

}  // namespace papilio::server
