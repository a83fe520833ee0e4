#include "server/openapi.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

#include "proto/parameters.h"
#include "proto/problem.h"
#include "server/endpoints.h"
#include "server/openapi_schemas.h"
#include "server/routes/refined_answer.h"

namespace papilio::server {
namespace {

using nlohmann::ordered_json;

ordered_json header(const std::string& type, const std::string& description) {
  return {{"description", description}, {"schema", {{"type", type}}}};
}

ordered_json headers() {
  return {{"X-Request-Id", header("string", "The client's own when it sent a sane one, else a fresh one")},
          {"Papilio-Vertices", header("integer", "Vertices of the mesh")},
          {"Papilio-Faces", header("integer", "Faces of the mesh")},
          {"Papilio-Levels", header("integer", "The last level that changed the mesh")},
          {"Papilio-Stop-Reason",
           {{"description", "Why there is no further level"},
            {"schema", {{"type", "string"}, {"enum", {"converged", "levels", "budget", "limits"}}}}}},
          {"Papilio-Error",
           header("number",
                  "Largest deviation left, as a share of the coarse mesh's diagonal, the grid of the answer "
                  "included; with tolerance or max_faces, in the red-green scheme without view or flatness, it "
                  "bounds the distance from the uniform result of the same levels")},
          {"Papilio-Error-Pixels", header("number", "The same in pixels of the view")},
          {"Papilio-Unreached", header("string", "Targets that were not reached, and what to do")},
          {"Papilio-Shape", header("string", "What the mesh was taken for, and how many creases were kept or marked")},
          {"Papilio-Found", header("string", "Defects of the coarse mesh, mended ones included, and how many")},
          {"Server-Timing", header("string", "Milliseconds of decode, refine and encode")},
          {"ETag", header("string", "Strong")},
          {"Cache-Control", header("string", "What caches may do with the answer")},
          {"Vary", header("string", "Request headers that the answer depends on")},
          {"Location", header("string", "Path of the mesh")},
          {"WWW-Authenticate", header("string", "How to show a key")},
          {"Allow", header("string", "Methods of the path")},
          {"Retry-After", header("integer", "Seconds to wait before the next try")}};
}

ordered_json header_references(const std::vector<std::string>& names) {
  ordered_json all = ordered_json::object();
  for (const std::string& name : names) all[name] = reference_to("headers/" + name);
  return all;
}

ordered_json content(const std::vector<std::string>& types, const ordered_json& schema) {
  ordered_json all = ordered_json::object();
  for (const std::string& type : types) all[type] = {{"schema", schema}};
  return all;
}

const ordered_json& binary() {
  // OpenAPI 3.1 needs no schema for bytes, but without `format` client generators send and expect JSON.
  static const ordered_json schema{{"type", "string"}, {"format", "binary"}};
  return schema;
}

ordered_json refined_answer() {
  ordered_json types = content({draco_type, bytes_type, multipart_type, scene_type}, binary());
  types[multipart_type]["schema"]["description"] =
      "Every level as a Draco mesh or a .glb scene of its own with its statistics as headers, the coarse one first, "
      "and a JSON summary. A problem after the stream has begun is its last part.";
  return {{"description", "The refined mesh"},
          {"headers",
           header_references({"X-Request-Id", "Papilio-Vertices", "Papilio-Faces", "Papilio-Levels",
                              "Papilio-Stop-Reason", "Papilio-Error", "Papilio-Error-Pixels", "Papilio-Unreached",
                              "Papilio-Shape", "Papilio-Found", "Server-Timing", "ETag", "Cache-Control", "Vary"})},
          {"content", types}};
}

ordered_json json_answer(const std::string& description, const std::string& schema) {
  return {{"description", description},
          {"headers", header_references({"X-Request-Id"})},
          {"content", content({json_type}, reference_to("schemas/" + schema))}};
}

ordered_json file_answer(const std::string& description, const std::vector<std::string>& types) {
  ordered_json bodies = ordered_json::object();
  for (const std::string& type : types)
    bodies[type]["schema"] = type.starts_with("text/") ? ordered_json{{"type", "string"}} : binary();
  return {{"description", description},
          {"headers", header_references({"X-Request-Id", "ETag", "Cache-Control"})},
          {"content", bodies}};
}

void add_successes(const Endpoint& endpoint, ordered_json& answers) {
  const ordered_json not_modified{{"description", "If-None-Match has the ETag"},
                                  {"headers", header_references({"X-Request-Id", "ETag", "Cache-Control", "Vary"})}};
  switch (endpoint.output) {
    case Output::refined:
      answers["200"] = refined_answer();
      if (endpoint.method == "GET") answers["304"] = not_modified;
      break;
    case Output::mesh:
      answers["200"] = {{"description", "The stored bytes, or their description"},
                        {"headers", header_references({"X-Request-Id", "ETag", "Cache-Control", "Vary"})},
                        {"content", content({draco_type, bytes_type, scene_type}, binary())}};
      answers["200"]["content"][json_type] = {{"schema", reference_to("schemas/Description")}};
      answers["304"] = not_modified;
      break;
    case Output::description:
      answers["201"] = json_answer("Stored", "Description");
      answers["200"] = json_answer("It was stored already", "Description");
      for (const char* status : {"200", "201"}) answers[status]["headers"].update(header_references({"Location"}));
      break;
    case Output::info:
      answers["200"] = json_answer("What this server is", "Info");
      break;
    case Output::health:
      answers["200"] = json_answer("Yes", "Health");
      break;
    case Output::metrics:
      answers["200"] = {{"description", "Prometheus' text format"},
                        {"content", {{"text/plain", {{"schema", {{"type", "string"}}}}}}}};
      break;
    case Output::openapi:
      answers["200"] = {{"description", "OpenAPI 3.1"}, {"content", {{json_type, {{"schema", {{"type", "object"}}}}}}}};
      break;
    case Output::page:
      answers["200"] = file_answer("The page", {"text/html"});
      answers["304"] = not_modified;
      break;
    case Output::asset:
      answers["200"] =
          file_answer("A script, a style sheet or a decoder", {"text/javascript", "text/css", "application/wasm"});
      answers["304"] = not_modified;
      break;
    case Output::sample:
      answers["200"] = file_answer("The mesh", {draco_type});
      answers["304"] = not_modified;
      break;
    case Output::nothing:
      answers["204"] = {{"description", "Done"}};
      break;
  }
}

/// Adds the answers of problems: one for each status, with its codes.
void add_problems(const Endpoint& endpoint, ordered_json& answers) {
  std::map<int, std::string> by_status;
  std::vector<proto::Code> codes = endpoint.problems;
  codes.insert(codes.end(), common_problems().begin(), common_problems().end());
  std::ranges::sort(codes);
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  for (const proto::Code code : codes) {
    const proto::ProblemKind& kind = proto::problem_kind(code);
    std::string& text = by_status[kind.status];
    text += (text.empty() ? "" : "; ") + std::string(kind.name) + ": " + std::string(kind.title);
  }
  for (const auto& [status, text] : by_status) {
    ordered_json& answer = answers[std::to_string(status)];
    answer = {{"description", text},
              {"headers", header_references({"X-Request-Id"})},
              {"content", content({"application/problem+json"}, reference_to("schemas/Problem"))}};
    if (status == 401) answer["headers"].update(header_references({"WWW-Authenticate"}));
    if (status == 405) answer["headers"].update(header_references({"Allow"}));
    if (status == 429 || status == 503) answer["headers"].update(header_references({"Retry-After"}));
  }
}

ordered_json request_body(Input input) {
  ordered_json types;
  if (input == Input::parameters) types = content({json_type}, reference_to("schemas/Parameters"));
  // Client generators use the first type, and treat this one as bytes.
  if (input == Input::mesh || input == Input::mesh_or_form)
    types = content({bytes_type, draco_type, scene_type}, binary());
  if (input == Input::mesh_or_form)
    types["multipart/form-data"] = {
        {"schema",
         {{"type", "object"},
          {"required", {"mesh"}},
          {"properties", {{"mesh", binary()}, {"params", reference_to("schemas/Parameters")}}}}}};
  ordered_json body{{"required", true}, {"content", types}};
  if (input == Input::mesh || input == Input::mesh_or_form)
    body["description"] =
        "A Draco mesh, a glTF scene (.glb), or a packed model (.glb), whose first levels are those of its detail";
  return body;
}

ordered_json operation(const Endpoint& endpoint) {
  ordered_json one{{"operationId", endpoint.name}, {"summary", endpoint.summary}};
  if (endpoint.access == Access::open) one["security"] = ordered_json::array();
  if (endpoint.access == Access::manage)
    one["description"] = "Where the server asks for keys, this takes one with the right to manage.";
  ordered_json parameters = ordered_json::array();
  if (endpoint.path.find("{name}") != std::string_view::npos) parameters.push_back(reference_to("parameters/name"));
  if (endpoint.path.find("{id}") != std::string_view::npos) parameters.push_back(reference_to("parameters/id"));
  if (endpoint.parameters)
    for (const proto::ParameterInfo& info : proto::parameter_table())
      parameters.push_back(reference_to("parameters/" + component_name(info.name)));
  if (!parameters.empty()) one["parameters"] = parameters;
  if (endpoint.input != Input::none) one["requestBody"] = request_body(endpoint.input);
  one["responses"] = ordered_json::object();
  add_successes(endpoint, one["responses"]);
  add_problems(endpoint, one["responses"]);
  return one;
}

}  // namespace

std::string openapi_json(const EngineOptions& options) {
  ordered_json document{{"openapi", "3.1.0"},
                        {"info",
                         {{"title", "Papilio"},
                          {"version", PAPILIO_VERSION},
                          {"summary", "Refines Draco meshes where they are curved, visible and large on screen"},
                          {"description",
                           "HEAD follows GET, and OPTIONS answers, everywhere. Parameters that are not known are "
                           "refused. A list in the query is written with commas or as repeated fields."},
                          {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
                        {"servers", {{{"url", "/"}}}},
                        {"security", {{{"key", ordered_json::array()}}, ordered_json::object()}},
                        {"paths", ordered_json::object()}};
  for (const Endpoint& endpoint : endpoints()) {
    std::string method(endpoint.method);
    std::ranges::transform(method, method.begin(), [](unsigned char c) { return std::tolower(c); });
    document["paths"][std::string(endpoint.path)][method] = operation(endpoint);
  }
  ordered_json parameters{{"id",
                           {{"name", "id"},
                            {"in", "path"},
                            {"required", true},
                            {"description", "SHA-256 of the mesh's bytes"},
                            {"schema", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}}}},
                          {"name",
                           {{"name", "name"},
                            {"in", "path"},
                            {"required", true},
                            {"description", "As /v1/info or the page has it"},
                            {"schema", {{"type", "string"}}}}}};
  parameters.update(openapi_parameters());
  document["components"] = {
      {"schemas", openapi_schemas(options)},
      {"parameters", parameters},
      {"headers", headers()},
      {"securitySchemes",
       {{"key", {{"type", "http"}, {"scheme", "bearer"}, {"description", "Only where the server asks for keys"}}}}}};
  return document.dump(2) + "\n";
}

Response openapi_route(Engine& engine, Request& /*request*/) {
  Response response;
  response.content_type = json_type;
  response.headers = {{"Cache-Control", "no-cache"}};
  response.body = openapi_json(engine.options());
  return response;
}

}  // namespace papilio::server
