#include "server/openapi_schemas.h"

#include <algorithm>

#include "proto/parameters.h"
#include "proto/problem.h"
#include "server/routes/service_routes.h"

namespace papilio::server {

using nlohmann::ordered_json;
using proto::ParameterInfo;
using proto::ParameterType;

ordered_json reference_to(const std::string& component) { return {{"$ref", "#/components/" + component}}; }

namespace {

/// Returns a number, as an integer if it is whole: JSON distinguishes 3 from 3.0.
ordered_json number(double value) {
  return value == static_cast<double>(static_cast<int64_t>(value)) ? ordered_json(static_cast<int64_t>(value))
                                                                   : ordered_json(value);
}

ordered_json parameter_schema(const ParameterInfo& info) {
  if (info.type == ParameterType::boolean) return {{"type", "boolean"}};
  if (info.type == ParameterType::choice) return {{"type", "string"}, {"enum", info.choices}};
  ordered_json one{{"type", info.type == ParameterType::integer ? "integer" : "number"},
                   {"minimum", number(info.min)},
                   {"maximum", number(info.max)}};
  if (info.type != ParameterType::numbers) return one;
  return {{"type", "array"}, {"items", one}, {"minItems", info.least}, {"maxItems", info.most}};
}

std::string parameter_description(const ParameterInfo& info) {
  std::string text(info.description);
  text += ". Default: " + proto::describe_default(info);
  if (!info.unit.empty()) text += " (" + std::string(info.unit) + ")";
  return text + ".";
}

/// Returns the schema of the parameters as one JSON object, nested at dots.
ordered_json parameters_schema() {
  ordered_json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", ordered_json::object()}};
  for (const ParameterInfo& info : proto::parameter_table()) {
    ordered_json one = parameter_schema(info);
    one["description"] = parameter_description(info);
    const size_t dot = info.name.find('.');
    const std::string first(info.name.substr(0, dot));
    ordered_json& properties = schema["properties"];
    if (dot == std::string_view::npos) {
      properties[first] = one;
      continue;
    }
    if (!properties.contains(first)) properties[first] = {{"type", "object"}, {"additionalProperties", false}};
    properties[first]["properties"][std::string(info.name.substr(dot + 1))] = one;
  }
  return schema;
}

ordered_json integer_schema(const std::string& description) {
  return {{"type", "integer"}, {"minimum", 0}, {"description", description}};
}

ordered_json problem_schema() {
  std::vector<std::string_view> codes;
  for (const proto::ProblemKind& kind : proto::problem_kinds()) codes.push_back(kind.name);
  return {{"type", "object"},
          {"description", "RFC 9457"},
          {"required", {"type", "code", "title", "status", "detail"}},
          {"properties",
           {{"type", {{"type", "string"}, {"description", "urn:papilio:problem: and the code"}}},
            {"code", {{"type", "string"}, {"enum", codes}}},
            {"title", {{"type", "string"}}},
            {"status", {{"type", "integer"}}},
            {"detail", {{"type", "string"}, {"description", "What is wrong here, and what to do"}}},
            {"parameter", {{"type", "string"}, {"description", "The parameter at fault, if one is"}}},
            {"request_id", {{"type", "string"}}}}}};
}

ordered_json description_schema() {
  return {{"type", "object"},
          {"required", {"id", "bytes", "vertices", "faces", "found", "refined"}},
          {"properties",
           {{"id", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}},
            {"bytes", integer_schema("Size of the stored bytes")},
            {"vertices", integer_schema("After equal points were welded")},
            {"faces", integer_schema("Without degenerate ones")},
            {"found",
             {{"type", "object"},
              {"description", "Defects by name, and how many of each. Mended: near_duplicates, t_junctions"},
              {"additionalProperties", {{"type", "integer"}}}}},
            {"refined", {{"type", "string"}, {"description", "Path of its refinements"}}}}}};
}

ordered_json sample_schema() {
  return {{"type", "object"},
          {"required", {"name", "path", "vertices", "faces", "bytes"}},
          {"properties",
           {{"name", {{"type", "string"}}},
            {"path", {{"type", "string"}, {"description", "Where its Draco bytes are"}}},
            {"vertices", integer_schema("Of the mesh")},
            {"faces", integer_schema("Of the mesh")},
            {"bytes", integer_schema("Of the mesh as Draco")}}}};
}

ordered_json info_schema(const EngineOptions& options) {
  ordered_json limits{{"type", "object"}, {"properties", ordered_json::object()}};
  for (const NamedLimit& limit : named_limits(options)) {
    limits["properties"][std::string(limit.name)] = {
        {"type", "integer"}, {"description", limit.description}, {"const", limit.value}};
    limits["required"].push_back(limit.name);
  }
  return {{"type", "object"},
          {"required", {"name", "version", "schemes", "limits", "parameters", "samples"}},
          {"properties",
           {{"name", {{"type", "string"}}},
            {"version", {{"type", "string"}}},
            {"schemes", {{"type", "array"}, {"items", {{"type", "string"}}}}},
            {"limits", limits},
            {"parameters", {{"type", "array"}, {"items", {{"type", "object"}}}}},
            {"samples", {{"type", "array"}, {"items", reference_to("schemas/Sample")}}}}}};
}

}  // namespace

std::string component_name(std::string_view parameter) {
  std::string name(parameter);
  std::ranges::replace(name, '.', '_');
  return name;
}

ordered_json openapi_parameters() {
  ordered_json all = ordered_json::object();
  for (const ParameterInfo& info : proto::parameter_table()) {
    ordered_json& row = all[component_name(info.name)];
    row = {{"name", info.name},
           {"in", "query"},
           {"description", parameter_description(info)},
           {"schema", parameter_schema(info)}};
    if (info.type == ParameterType::numbers) row.update({{"style", "form"}, {"explode", false}});
  }
  return all;
}

ordered_json openapi_schemas(const EngineOptions& options) {
  return {
      {"Parameters", parameters_schema()},
      {"Problem", problem_schema()},
      {"Description", description_schema()},
      {"Info", info_schema(options)},
      {"Sample", sample_schema()},
      {"Health", {{"type", "object"}, {"required", {"status"}}, {"properties", {{"status", {{"type", "string"}}}}}}}};
}

}  // namespace papilio::server
