#include "client/lib/remote.h"

#include <httplib.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <climits>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "client/lib/mesh_stream.h"
#include "proto/draco_reader.h"
#include "proto/findings.h"
#include "proto/gltf/scene_description.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using nlohmann::json;

constexpr const char* draco_type = "application/x-draco";
constexpr const char* scene_type = "model/gltf-binary";
constexpr uint64_t longest_mesh = 4ULL << 30;
constexpr uint64_t longest_document = 64 << 10;
constexpr int ok_status = 200;
constexpr int busy_status = 429;
constexpr int most_attempts = 30;
constexpr uint64_t longest_pause_seconds = 10;
constexpr const char* who_is_there = "Is papilio-server running there, and is the address right?";

/// Returns the text of a document's field, escaped for a terminal; "" if there is none.
std::string text_of(const json& document, const char* field) {
  if (!document.is_object() || !document.contains(field) || !document[field].is_string()) return "";
  return proto::escape_controls(document[field].get<std::string>());
}

/// Converts the server's problem document, or another answer, to an exception.
ServerError error_from(int status, const std::string& body) {
  const json document = json::parse(body, nullptr, false);
  std::string text = text_of(document, "detail");
  if (text.empty())
    return {status, "", "The server answered with status " + std::to_string(status) + " and no explanation."};
  if (const std::string id = text_of(document, "request_id"); !id.empty()) text += " (request " + id + ")";
  return {status, text_of(document, "code"), text};
}

ServerError no_answer(const std::string& origin, httplib::Error error) {
  std::string advice = who_is_there;
  if (error == httplib::Error::SSLServerVerification)
    advice = "The certificate is for another host, or its issuer is not trusted. Name trusted certificates with --ca.";
  if (error == httplib::Error::SSLLoadingCerts)
    advice = "The certificates of --ca cannot be read; it names a PEM file.";
  return {0, "", "No answer from " + origin + " (" + httplib::to_string(error) + "). " + advice};
}

httplib::Client connect(const std::string& origin, const RemoteOptions& options) {
  httplib::Client client(origin);
  if (!options.ca_file.empty()) client.set_ca_cert_path(options.ca_file);
  if (!options.key.empty()) client.set_bearer_token_auth(options.key);
  client.set_connection_timeout(10);
  client.set_read_timeout(600);
  client.set_write_timeout(60);
  client.set_tcp_nodelay(true);
  return client;
}

/// Parses a count; returns 0 for other text.
uint64_t count_of(const std::string& header) {
  constexpr double most = 1e15;
  return static_cast<uint64_t>(std::clamp(proto::parse_number(header).value_or(0), 0.0, most));
}

/// Returns the media type without parameters, in lower case.
std::string media_type(const httplib::Response& response) {
  std::string type = response.get_header_value("Content-Type");
  type.resize(std::min(type.size(), type.find_first_of("; \t")));
  std::ranges::transform(type, type.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type;
}

/// Returns the fault of an answer's header; "" if there is none. Without a length, the end of a body cannot be
/// distinguished from a broken connection.
std::string fault_of(const httplib::Response& response, const std::string& type) {
  const std::string found = media_type(response);
  if (found != type) return (found.empty() ? "no Content-Type" : proto::quote(found)) + ", not with " + type;
  const bool has_length = response.has_header("Content-Length") || response.has_header("Transfer-Encoding");
  return has_length ? "" : "neither Content-Length nor Transfer-Encoding";
}

/// Sends a request whose answer of status 200 must have the media type `type`, a length, and at most `longest` bytes;
/// the body of any other answer is not read. Refusals by the server are returned. Throws `ServerError`. Sets the
/// request's handlers.
httplib::Response exchange(const std::string& origin, httplib::Client& client, httplib::Request& request,
                           const std::string& type, uint64_t longest) {
  std::string refusal;
  std::string body;
  int status = 0;
  request.response_handler = [&](const httplib::Response& response) {
    status = response.status;
    if (status == ok_status) refusal = fault_of(response, type);
    return refusal.empty();
  };
  request.content_receiver = [&](const char* data, size_t size, uint64_t, uint64_t) {
    const uint64_t most = status == ok_status ? longest : longest_document;
    if (size > most - body.size())
      refusal = "more than " + std::to_string(most) + " bytes";
    else
      body.append(data, size);
    return refusal.empty();
  };
  httplib::Result result = client.send(request);
  if (!refusal.empty()) throw ServerError(status, "", origin + " answered with " + refusal + ". " + who_is_there);
  if (!result && status != 0)
    throw ServerError(
        status, "",
        "The answer of " + origin + " broke off after " + std::to_string(body.size()) + " bytes. Try again.");
  if (!result) throw no_answer(origin, result.error());
  httplib::Response response = std::move(*result);
  response.body = std::move(body);
  return response;
}

/// Throws `ServerError` unless the body is a Draco mesh with the number of faces that the header declares.
void check_mesh(const std::string& origin, const httplib::Response& response) {
  const std::string size = std::to_string(response.body.size());
  size_t faces = 0;
  try {
    faces = proto::read_draco(response.body, own_limits).triangles.size();
  } catch (const proto::Problem&) {
    throw ServerError(ok_status, "",
                      origin + " answered with " + size + " bytes that are no whole Draco mesh. Try again.");
  }
  const std::string declared = response.get_header_value("Papilio-Faces");
  if (faces != count_of(declared))
    throw ServerError(ok_status, "",
                      origin + " answered with a mesh of " + std::to_string(faces) + " faces, but Papilio-Faces is " +
                          proto::quote(declared) + ". Try again.");
}

/// Returns the time of a stage in "decode;dur=1.2, refine;dur=3.4, encode;dur=5.6".
double stage_time(const std::string& server_timing, const std::string& stage) {
  const size_t found = server_timing.find(stage + ";dur=");
  if (found == std::string::npos) return 0;
  const size_t begin = found + stage.size() + 5;
  const size_t end = server_timing.find_first_of(",; ", begin);
  return proto::parse_number(std::string_view(server_timing).substr(begin, end - begin)).value_or(0);
}

proto::Statistics statistics_from(const httplib::Headers& headers) {
  const auto field = [&](const char* name) {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
  };
  proto::Statistics statistics;
  statistics.vertices = count_of(field("Papilio-Vertices"));
  statistics.faces = count_of(field("Papilio-Faces"));
  statistics.level = static_cast<int>(std::min<uint64_t>(count_of(field("Papilio-Levels")), INT_MAX));
  statistics.stop_reason = proto::stop_reason_named(field("Papilio-Stop-Reason"));
  statistics.error = proto::parse_number(field("Papilio-Error")).value_or(0);
  statistics.error_pixels = proto::parse_number(field("Papilio-Error-Pixels"));
  statistics.unreached = field("Papilio-Unreached");
  statistics.shape = field("Papilio-Shape");
  statistics.found = proto::parse_defects(field("Papilio-Found"));
  const std::string timing = field("Server-Timing");
  statistics.times = {stage_time(timing, "decode"), stage_time(timing, "refine"), stage_time(timing, "encode")};
  return statistics;
}

/// Sends a body to be refined, and repeats that while the server is busy. Returns its answer of media type `type`.
/// Throws `ServerError`.
httplib::Response ask_to_refine(const std::string& origin, httplib::Client& client, const std::string& prefix,
                                const char* type, std::string_view body, const proto::Parameters& parameters) {
  httplib::Request request;
  request.method = "POST";
  request.path = prefix + "/v1/refine?" + proto::to_query(parameters);
  request.headers = {{"Accept", type}, {"Content-Type", proto::gltf::is_glb(body) ? scene_type : draco_type}};
  request.body = std::string(body);
  const auto ask = [&] { return exchange(origin, client, request, type, longest_mesh); };
  httplib::Response answer = ask();
  for (int attempt = 1; attempt < most_attempts && answer.status == busy_status; ++attempt) {
    std::this_thread::sleep_for(std::chrono::seconds(
        std::clamp<uint64_t>(count_of(answer.get_header_value("Retry-After")), 1, longest_pause_seconds)));
    answer = ask();
  }
  if (answer.status != ok_status) throw error_from(answer.status, answer.body);
  return answer;
}

/// Throws `ServerError` unless the body is a readable scene.
void check_scene(const std::string& origin, const httplib::Response& response) {
  try {
    (void)proto::gltf::describe_scene(response.body, own_limits);
  } catch (const proto::Problem&) {
    throw ServerError(ok_status, "",
                      origin + " answered with " + std::to_string(response.body.size()) +
                          " bytes that are no whole glTF scene. Try again.");
  }
}

}  // namespace

Remote::Remote(const std::string& url, RemoteOptions options) : options_(std::move(options)) {
  static const std::regex form(R"((https?://[^/?#\s]+)(/[^?#\s]*)?)");
  std::smatch match;
  if (!std::regex_match(url, match, form))
    throw std::invalid_argument("The server must be a URL such as http://localhost:8080, not " + proto::quote(url) +
                                ".");
  origin_ = match[1];
  prefix_ = match[2];
  while (prefix_.ends_with('/')) prefix_.pop_back();
}

proto::EncodedLevel Remote::refine(std::string_view bytes, const proto::Parameters& parameters) const {
  httplib::Client client = connect(origin_, options_);
  httplib::Response answer = ask_to_refine(origin_, client, prefix_, draco_type, bytes, parameters);
  check_mesh(origin_, answer);
  return {std::move(answer.body), statistics_from(answer.headers)};
}

proto::EncodedLevel Remote::refine_scene(std::string_view glb, const proto::Parameters& parameters) const {
  httplib::Client client = connect(origin_, options_);
  httplib::Response answer = ask_to_refine(origin_, client, prefix_, scene_type, glb, parameters);
  check_scene(origin_, answer);
  return {std::move(answer.body), statistics_from(answer.headers)};
}

void Remote::refine_levels(std::string_view draco, const proto::Parameters& parameters,
                           const std::function<void(const proto::BodyPart&)>& on_part) const {
  httplib::Request request;
  request.method = "POST";
  request.path = prefix_ + "/v1/refine?" + proto::to_query(parameters);
  request.headers = {{"Accept", "multipart/mixed"}, {"Content-Type", draco_type}};
  request.body = std::string(draco);

  int status = 0;
  std::string refusal;
  std::string failure;  ///< problem document received as a part
  std::optional<proto::MultipartReader> reader;
  const auto take_part = [&](const proto::BodyPart& part) {
    if (part.header("Content-Type") == "application/problem+json")
      failure = part.body;
    else
      on_part(part);
  };
  request.response_handler = [&](const httplib::Response& response) {
    status = response.status;
    if (status == ok_status) reader.emplace(response.get_header_value("Content-Type"), longest_mesh, take_part);
    return true;
  };
  request.content_receiver = [&](const char* data, size_t size, uint64_t, uint64_t) {
    if (reader)
      reader->feed({data, size});
    else
      refusal.append(data, size);
    return refusal.size() <= longest_document;
  };

  httplib::Client client = connect(origin_, options_);
  try {
    const auto answer = client.send(request);
    if (!answer) throw no_answer(origin_, answer.error());
    if (status != ok_status) throw error_from(status, refusal);
    if (!failure.empty()) throw error_from(status, failure);
    reader->finish();
  } catch (const proto::Problem& problem) {  // thrown by the reader
    throw ServerError(status, "", problem.what());
  }
}

std::string Remote::health(Health question) const {
  constexpr int longest_seconds = 3;
  httplib::Client client = connect(origin_, options_);
  client.set_connection_timeout(longest_seconds);
  client.set_read_timeout(longest_seconds);
  httplib::Request request;
  request.method = "GET";
  request.path = prefix_ + (question == Health::ready ? "/ready" : "/health");
  const httplib::Response answer = exchange(origin_, client, request, "application/json", longest_document);
  if (answer.status != ok_status) throw error_from(answer.status, answer.body);
  std::string yes = question == Health::ready ? "ready" : "alive";
  if (text_of(json::parse(answer.body, nullptr, false), "status") != yes)
    throw ServerError(answer.status, "", "What answers at " + origin_ + " is no papilio-server. Is the address right?");
  return yes;
}

}  // namespace papilio::client
