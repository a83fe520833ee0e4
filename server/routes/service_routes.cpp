#include "server/routes/service_routes.h"

#include <nlohmann/json.hpp>

#include "proto/parameters.h"
#include "proto/problem.h"
#include "server/routes/refined_answer.h"

namespace papilio::server {

using nlohmann::ordered_json;

namespace {

Response json_response(const ordered_json& document) {
  Response response;
  response.content_type = json_type;
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = document.dump(2) + "\n";
  return response;
}

}  // namespace

std::vector<NamedLimit> named_limits(const EngineOptions& options) {
  const proto::Limits& limits = options.limits;
  return {
      {"max_body_bytes", options.max_body_bytes, "Largest request body: 413"},
      {"max_input_faces", limits.max_input_faces, "Most faces of a mesh sent: 413"},
      {"max_input_vertices", limits.max_input_vertices, "Most vertices of a mesh sent: 413"},
      {"max_output_faces", limits.max_output_faces, "Most faces of any level: 507"},
      {"max_compute_bytes", limits.max_compute_bytes,
       "Most memory of a refinement and of its encoding: 507; 0: no limit"},
      {"max_compute_seconds", static_cast<uint64_t>(limits.max_compute_seconds),
       "Longest time of a refinement: 507; 0: no limit"},
      {"slots", static_cast<uint64_t>(options.slots), "Requests computed at once"},
      {"queue", static_cast<uint64_t>(options.queue), "Requests that may wait for a slot; more: 429"},
  };
}

Response info_route(Engine& engine, Request& /*request*/) {
  ordered_json document{{"name", "papilio"}, {"version", PAPILIO_VERSION}};
  for (const proto::ParameterInfo& parameter : proto::parameter_table())
    if (parameter.name == "scheme") document["schemes"] = parameter.choices;
  for (const NamedLimit& limit : named_limits(engine.options()))
    document["limits"][std::string(limit.name)] = limit.value;
  document["parameters"] = ordered_json::parse(proto::parameters_json());
  document["samples"] = ordered_json::array();
  for (const Sample& sample : engine.samples().all())
    document["samples"].push_back({{"name", sample.name},
                                   {"path", "/v1/samples/" + sample.name},
                                   {"vertices", sample.vertices},
                                   {"faces", sample.faces},
                                   {"bytes", sample.draco->size()}});
  return json_response(document);
}

Response health_route(Engine& /*engine*/, Request& /*request*/) { return json_response({{"status", "alive"}}); }

Response ready_route(Engine& engine, Request& /*request*/) {
  if (engine.admission().full())
    throw proto::Problem(proto::Code::not_ready, "Every computing slot and waiting place is taken.");
  return json_response({{"status", "ready"}});
}

Response metrics_route(Engine& engine, Request& /*request*/) {
  Response response;
  response.content_type = "text/plain; version=0.0.4; charset=utf-8";
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = engine.metrics_text();
  return response;
}

}  // namespace papilio::server
