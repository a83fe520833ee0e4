#include "server/routes/refine_route.h"

#include <memory>

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
                                           "; its parts are \"mesh\" (Draco) and \"params\" (JSON).");
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
  if (!type.empty() && type != draco_type && type != bytes_type)
    throw Problem(Code::unsupported_media_type,
                  "Bodies of type " + proto::quote(type) +
                      " are not read here. Send a Draco file with -H 'Content-Type: application/x-draco', or a form "
                      "with parts mesh and params.");
  Parameters parameters = proto::parse_query(request.query());
  return {request.read_body().bytes, std::move(parameters)};
}

}  // namespace

Response refine_route(Engine& engine, Request& request) {
  const std::string type = negotiate_refined(request);
  engine.admission().refuse_when_full(request.client());
  const Order order = read_order(request);
  const auto gone = [&] { return request.client_gone(); };
  auto slot = engine.enter(request, engine.work_of(order.mesh, order.parameters.options), gone);
  auto refinement = std::make_shared<Refinement>(order.mesh, order.parameters, engine.limits());
  if (type == multipart_type) return level_stream(engine, request, std::move(slot), std::move(refinement));
  proto::EncodedLevel made = engine.run(*refinement, {.cancelled = gone}, *slot);
  Response response = refined_response(made.statistics, type);
  response.body = std::move(made.draco);
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

}  // namespace papilio::server
