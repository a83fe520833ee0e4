#include "server/service.h"

#include <nlohmann/json.hpp>

#include "proto/parameters.h"
#include "proto/problem.h"
#include "server/refine_route.h"

namespace papilio::server {

using nlohmann::ordered_json;
using proto::Code;
using proto::Problem;

namespace {

Response json_response(const ordered_json& document) {
  Response response;
  response.content_type = "application/json";
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = document.dump(2) + "\n";
  return response;
}

}  // namespace

Service::Service(const proto::Limits& limits, uint64_t max_body_bytes, int slots, int queue)
    : limits_(limits), max_body_bytes_(max_body_bytes), admission_(slots, queue) {}

void Service::add_routes(HttpServer& server) {
  server.add("POST", "/v1/refine", [this](Request& request) { return refine_route(request, limits_, admission_); });
  server.add("GET", "/v1/info", [this](Request&) { return info(); });
  server.add(
      "GET", "/health",
      [](Request&) {
        return json_response({{"status", "alive"}});
      },
      WhileDraining::answer);
  server.add("GET", "/ready", [this](Request&) { return ready(); });
}

Response Service::info() const {
  ordered_json document{{"name", "papilio"}, {"version", PAPILIO_VERSION}};
  for (const proto::ParameterInfo& parameter : proto::parameter_table())
    if (parameter.name == "scheme") document["schemes"] = parameter.choices;
  document["limits"] = {{"max_body_bytes", max_body_bytes_},
                        {"max_input_faces", limits_.max_input_faces},
                        {"max_input_vertices", limits_.max_input_vertices},
                        {"max_output_faces", limits_.max_output_faces}};
  document["parameters"] = ordered_json::parse(proto::parameters_json());
  return json_response(document);
}

Response Service::ready() const {
  if (admission_.full()) throw Problem(Code::not_ready, "Every computing slot and waiting place is taken.");
  return json_response({{"status", "ready"}});
}

}  // namespace papilio::server
