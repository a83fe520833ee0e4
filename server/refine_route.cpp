#include "server/refine_route.h"

#include <memory>

#include "proto/multipart.h"
#include "proto/parameters.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "proto/text.h"
#include "server/accept.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::EncodedLevel;
using proto::Parameters;
using proto::Problem;
using proto::Refinement;

constexpr const char* draco_type = "application/x-draco";
constexpr const char* bytes_type = "application/octet-stream";
constexpr const char* multipart_type = "multipart/mixed";

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

proto::Part level_part(const EncodedLevel& level) {
  proto::Part part{{{"Content-Type", draco_type}}, level.draco};
  for (auto& header : proto::statistics_headers(level.statistics)) part.headers.push_back(std::move(header));
  return part;
}

struct ClientGone {};

void stream_levels(Refinement& refinement, const Request& request, const proto::MultipartWriter& writer, Sink& sink) {
  const auto send = [&](const proto::Part& part) {
    if (!sink.write(writer.part(part))) throw ClientGone();
  };
  const auto fail = [&](const Problem& problem) {
    send({{{"Content-Type", "application/problem+json"}}, problem.json(request.id())});
  };
  try {
    try {
      const EncodedLevel last = refinement.run({.on_level = [&](const EncodedLevel& level) { send(level_part(level)); },
                                                .cancelled = [&] { return request.client_gone(); }});
      send({{{"Content-Type", "application/json"}}, proto::statistics_json(last.statistics)});
    } catch (const Problem& problem) {
      fail(problem);
    } catch (const std::exception&) {
      fail(Problem(Code::internal, "Something failed inside the server. The request id finds it in the log."));
    }
    sink.write(writer.end());
  } catch (const ClientGone&) {  // nobody is left to tell
  }
}

}  // namespace

Response refine_route(Request& request, const proto::Limits& limits, Admission& admission) {
  const std::string accept = request.header("Accept");
  const auto type = negotiate(accept, {draco_type, bytes_type, multipart_type});
  if (!type)
    throw Problem(Code::not_acceptable, "Accept is " + proto::quote(accept) +
                                            ", but the answer can only be application/x-draco, "
                                            "application/octet-stream or multipart/mixed.");
  admission.refuse_when_full();
  const Order order = read_order(request);
  const auto slot = admission.enter([&] { return request.client_gone(); });
  const auto refinement = std::make_shared<Refinement>(order.mesh, order.parameters, limits);

  Response response;
  response.headers = {{"Cache-Control", "no-store"}, {"Vary", "Accept"}};
  if (*type == multipart_type) {
    response.headers.emplace_back("X-Accel-Buffering", "no");  // a proxy is to pass each level on as it comes
    const proto::MultipartWriter writer;
    response.content_type = writer.content_type();
    // The slot goes along, and is given back when the stream is done.
    response.stream = [refinement, slot, writer, &request](Sink& sink) {
      stream_levels(*refinement, request, writer, sink);
    };
    return response;
  }
  EncodedLevel made = refinement->run({.cancelled = [&] { return request.client_gone(); }});
  response.content_type = *type;
  for (auto& header : proto::statistics_headers(made.statistics)) response.headers.push_back(std::move(header));
  response.body = std::move(made.draco);
  return response;
}

}  // namespace papilio::server
