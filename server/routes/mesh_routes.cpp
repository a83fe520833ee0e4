#include "server/routes/mesh_routes.h"

#include <nlohmann/json.hpp>

#include "proto/findings.h"
#include "proto/gltf/container.h"
#include "proto/gltf/scene_description.h"
#include "proto/parameters.h"
#include "proto/problem.h"
#include "proto/results_version.h"
#include "proto/text.h"
#include "server/accept.h"
#include "server/http/head.h"
#include "server/routes/refined_answer.h"
#include "server/sha256.h"

namespace papilio::server {

using nlohmann::ordered_json;
using proto::Code;
using proto::Parameters;
using proto::Problem;
using proto::Refinement;

namespace {

Problem no_such_mesh() {
  return {Code::mesh_not_found, "No mesh is stored under this id. Send it to POST /v1/meshes, which answers its id."};
}

std::string path_of(const std::string& id) { return "/v1/meshes/" + id; }

/// Returns the value of Cache-Control. `immutable`: the content is addressed by its hash.
std::string cache_control(const Engine& engine, int seconds, bool immutable) {
  return std::string(engine.options().keyed ? "private" : "public") + ", max-age=" + std::to_string(seconds) +
         (immutable ? ", immutable" : "");
}

std::string description(const std::string& id, size_t bytes, const Refinement& mesh) {
  ordered_json document{{"id", id},
                        {"bytes", bytes},
                        {"vertices", mesh.coarse_vertices()},
                        {"faces", mesh.coarse_faces()},
                        {"found", ordered_json::object()},
                        {"refined", path_of(id) + "/refined"}};
  for (const auto& [name, count] : proto::defects(mesh.found())) document["found"][std::string(name)] = count;
  return document.dump(2) + "\n";
}

std::string scene_description(const std::string& id, const std::string& glb, const proto::Limits& limits) {
  ordered_json document{{"id", id}, {"bytes", glb.size()}};
  document.update(ordered_json::parse(proto::gltf::describe_scene(glb, limits)));
  document["refined"] = path_of(id) + "/refined";
  return document.dump(2) + "\n";
}

Response not_modified(const Fields& headers) {
  Response response;
  response.status = 304;
  response.headers = headers;
  return response;
}

Parameters unrefined() {
  Parameters parameters;
  parameters.options.levels = 0;
  return parameters;
}

constexpr int year = 31'536'000;

Work work_of_bytes(const Engine& engine, const std::string& mesh) {
  const papilio::Options options = unrefined().options;
  return proto::gltf::is_glb(mesh) ? engine.work_of_scene(mesh, options) : engine.work_of(mesh, options);
}

/// Describes a mesh or a scene. Requires a slot.
std::string description_of(const Engine& engine, const std::string& id, const std::string& mesh) {
  if (proto::gltf::is_glb(mesh)) return scene_description(id, mesh, engine.limits());
  return description(id, mesh.size(), Refinement(mesh, unrefined(), engine.limits()));
}

}  // namespace

std::string mesh_id(const Request& request) {
  std::string id = request.path_parameter("id");
  if (!is_sha256(id)) throw no_such_mesh();
  return id;
}

std::string entity_tag(const std::string& id, const Parameters& parameters, const std::string& type) {
  return '"' +
         sha256(proto::results_version() + '\n' + id + '\n' + proto::to_query(parameters) + '\n' + type).substr(0, 32) +
         '"';
}

bool none_match_has(const std::string& if_none_match, const std::string& tag) {
  std::string_view rest = if_none_match;
  while (!rest.empty()) {
    std::string_view item = trimmed(rest.substr(0, rest.find(',')));
    rest.remove_prefix(
        std::min(rest.size(), rest.find(',') == std::string_view::npos ? rest.size() : rest.find(',') + 1));
    if (item.starts_with("W/")) item.remove_prefix(2);
    if (item == tag || item == "*") return true;
  }
  return false;
}

Response store_mesh(Engine& engine, Request& request) {
  if (!request.query().empty())
    throw Problem(Code::unknown_parameter, "Storing a mesh takes no parameters; they come with the refinement.",
                  proto::shorten(request.query().front().first));
  const std::string type = request.content_type();
  if (type != draco_type && type != bytes_type && type != scene_type)
    throw Problem(Code::unsupported_media_type,
                  "Bodies of type " + proto::quote(type) +
                      " are not stored. Send a Draco file with -H 'Content-Type: application/x-draco', or a .glb file "
                      "with model/gltf-binary.");
  engine.admission().refuse_when_full(request.client());
  const std::string mesh = request.read_body().bytes;
  if (type == scene_type && !proto::gltf::is_glb(mesh))
    throw Problem(Code::mesh_not_gltf, "The body is not a .glb file. Only .glb scenes can be stored.");
  const std::string id = sha256(mesh);
  std::string described;
  {
    const auto slot = engine.enter(request, work_of_bytes(engine, mesh), [&] { return request.client_gone(); });
    described = description_of(engine, id, mesh);
  }
  Response response;
  response.status = engine.store().put(id, mesh) ? 201 : 200;
  response.content_type = json_type;
  response.headers = {{"Location", path_of(id)}, {"Cache-Control", "no-store"}};
  response.body = std::move(described);
  return response;
}

Response stored_mesh(Engine& engine, Request& request) {
  const std::string id = mesh_id(request);
  const std::string accept = request.header("Accept");
  const bool is_scene = engine.is_scene(id);
  const char* const own_type = is_scene ? scene_type : draco_type;
  const auto type = negotiate(accept, {own_type, bytes_type, json_type});
  if (!type)
    throw Problem(Code::not_acceptable, "Accept is " + proto::quote(accept) + ", but the mesh is " + own_type +
                                            " or application/octet-stream, and its description application/json.");
  // Two representations never share a tag. The description depends on the server's version, the bytes do not.
  const bool describes = type == json_type;
  const std::string tag = describes ? entity_tag(id, unrefined(), *type + " " PAPILIO_VERSION)
                                    : '"' + id.substr(0, 32) + (type == own_type ? "\"" : "-b\"");
  Response response;
  response.headers = {{"ETag", tag},
                      {"Cache-Control", describes ? cache_control(engine, engine.options().cache_seconds, false)
                                                  : cache_control(engine, year, true)},
                      {"Vary", "Accept"}};
  if (none_match_has(request.header("If-None-Match"), tag) && engine.store().contains(id))
    return not_modified(response.headers);
  const MeshStore::Bytes mesh = engine.store().get(id);
  if (mesh == nullptr) throw no_such_mesh();
  response.content_type = *type;
  if (describes) {
    const auto slot = engine.enter(request, work_of_bytes(engine, *mesh), [&] { return request.client_gone(); });
    response.body = description_of(engine, id, *mesh);
  } else {
    response.shared = mesh;
  }
  return response;
}

Response delete_mesh(Engine& engine, Request& request) {
  if (!engine.store().remove(mesh_id(request))) throw no_such_mesh();
  Response response;
  response.status = 204;
  return response;
}

namespace {

Parameters read_parameters(Request& request) {
  if (request.method() != "POST") return proto::parse_query(request.query());
  if (!request.query().empty())
    throw Problem(Code::bad_request, "With POST, parameters belong into the JSON body, not into the query.");
  if (request.content_type() != json_type)
    throw Problem(Code::unsupported_media_type,
                  "Send the parameters as JSON, with -H 'Content-Type: application/json'.");
  return proto::parse_json(request.read_body().bytes);
}

/// Returns whether a mesh is stored. While the store is unavailable, a cached result suffices.
bool is_stored(Engine& engine, const std::string& id, const std::string& key) {
  try {
    return engine.store().contains(id);
  } catch (const Problem& problem) {
    if (problem.code() == Code::store_unavailable && engine.results().get(key) != nullptr) return true;
    throw;
  }
}

/// Returns whether a stored mesh is answered as a scene, or a scene as a mesh.
bool changes_kind(Engine& engine, const std::string& id, const std::string& type) {
  return type == (engine.is_scene(id) ? draco_type : scene_type);
}

/// Returns the refinement of a stored mesh or scene, ready to run. `type`: type of the answer.
RunRefinement run_of_stored(Engine& engine, const std::string& id, const Parameters& parameters,
                            const std::string& type) {
  const bool changes = changes_kind(engine, id, type);
  if (engine.is_scene(id) && changes)
    return run_of(engine, std::make_shared<Refinement>(mesh_of_scene(*engine.stored_bytes(id), engine.limits()),
                                                       parameters, engine.limits()));
  if (engine.is_scene(id)) return run_of(engine, std::shared_ptr(engine.scene_refinement_of(id, parameters)));
  RunRefinement run = run_of(engine, std::shared_ptr(engine.mesh_refinement_of(id, parameters)));
  if (!changes) return run;
  return [run = std::move(run)](proto::RefinementHooks hooks, Admission::Slot& slot) {
    proto::EncodedLevel made = run(std::move(hooks), slot);
    made.bytes = scene_of_draco(made.bytes);
    return made;
  };
}

ResultCache::Answer find_or_make(Engine& engine, const Request& request, const std::string& id,
                                 const Parameters& parameters, const std::string& type) {
  // Equal kinds have equal bytes under any name of their type.
  const std::string key = entity_tag(id, parameters, changes_kind(engine, id, type) ? type : "");
  const auto make = [&](const std::function<bool()>& abandoned) {
    const auto slot = engine.enter(request, engine.work_of_stored(id, parameters.options), abandoned);
    const RunRefinement run = run_of_stored(engine, id, parameters, type);
    auto made = std::make_shared<const proto::EncodedLevel>(run({.on_level = {}, .cancelled = abandoned}, *slot));
    engine.count_again(id);
    return made;
  };
  ResultCache::Answer answer = engine.results().get_or_make(key, make, [&] { return request.client_gone(); });
  engine.metrics().count_lookup(Metrics::Cache::results, answer.source == ResultCache::Source::kept);
  if (answer.source == ResultCache::Source::shared) engine.metrics().count_shared();
  return answer;
}

}  // namespace

Response refined_mesh(Engine& engine, Request& request) {
  const std::string id = mesh_id(request);
  (void)negotiate_refined(request, false);
  const Parameters parameters = read_parameters(request);
  if (!is_stored(engine, id, entity_tag(id, parameters, ""))) throw no_such_mesh();
  const std::string type = negotiate_refined(request, engine.is_scene(id));
  if (type == multipart_type) {
    auto slot =
        engine.enter(request, engine.work_of_stored(id, parameters.options), [&] { return request.client_gone(); });
    return level_stream(engine, request, std::move(slot), engine.is_scene(id) ? scene_type : draco_type,
                        run_of_stored(engine, id, parameters, type));
  }
  const bool cacheable = request.method() != "POST";
  const std::string tag = entity_tag(id, parameters, type);
  const Fields validators{{"ETag", tag},
                          {"Cache-Control", cacheable ? cache_control(engine, engine.options().cache_seconds, false)
                                                      : std::string("no-store")}};
  if (cacheable && none_match_has(request.header("If-None-Match"), tag)) {
    Fields headers = validators;
    headers.emplace_back("Vary", "Accept");
    return not_modified(headers);
  }
  const ResultCache::Answer answer = find_or_make(engine, request, id, parameters, type);
  proto::Statistics statistics = answer.result->statistics;
  if (answer.source == ResultCache::Source::kept) statistics.times = {};  // no time was spent on this request
  Response response = refined_response(statistics, type);
  response.shared = {answer.result, &answer.result->bytes};
  response.headers.insert(response.headers.end(), validators.begin(), validators.end());
  return response;
}

}  // namespace papilio::server
