#include "client/lib/remote.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "proto/findings.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using nlohmann::json;

constexpr const char* draco_type = "application/x-draco";
constexpr uint64_t longest_part = 4ULL << 30;
constexpr int busy_status = 429;
constexpr int most_attempts = 30;
constexpr uint64_t longest_pause_seconds = 10;

/// The server's problem document as an exception; other answers as they are.
ServerError error_from(int status, const std::string& body) {
  const json document = json::parse(body, nullptr, false);
  if (!document.is_object() || !document.contains("detail") || !document["detail"].is_string())
    return {status, "", "The server answered with status " + std::to_string(status) + " and no explanation."};
  std::string text = document["detail"];
  if (document.contains("request_id") && document["request_id"].is_string())
    text += " (request " + document["request_id"].get<std::string>() + ")";
  const std::string code = document.contains("code") && document["code"].is_string() ? document["code"] : "";
  return {status, code, text};
}

ServerError no_answer(const std::string& origin, httplib::Error error) {
  std::string advice = "Is papilio-server running there, and is the address right?";
  if (error == httplib::Error::SSLServerVerification)
    advice = "Its certificate is not of this name, or is not signed by one that is trusted here; --ca names another.";
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

uint64_t count_of(const std::string& header) { return static_cast<uint64_t>(proto::parse_number(header).value_or(0)); }

/// decode;dur=1.2, refine;dur=3.4, encode;dur=5.6
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
  statistics.level = static_cast<int>(count_of(field("Papilio-Levels")));
  statistics.stop_reason = proto::stop_reason_named(field("Papilio-Stop-Reason"));
  statistics.error = proto::parse_number(field("Papilio-Error")).value_or(0);
  statistics.error_pixels = proto::parse_number(field("Papilio-Error-Pixels"));
  statistics.found = proto::parse_defects(field("Papilio-Found"));
  const std::string timing = field("Server-Timing");
  statistics.times = {stage_time(timing, "decode"), stage_time(timing, "refine"), stage_time(timing, "encode")};
  return statistics;
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

proto::EncodedLevel Remote::refine(std::string_view draco, const proto::Parameters& parameters) const {
  httplib::Client client = connect(origin_, options_);
  const std::string path = prefix_ + "/v1/refine?" + proto::to_query(parameters);
  auto answer = client.Post(path, {{"Accept", draco_type}}, draco.data(), draco.size(), draco_type);
  for (int attempt = 1; attempt < most_attempts && answer && answer->status == busy_status; ++attempt) {
    std::this_thread::sleep_for(std::chrono::seconds(
        std::clamp<uint64_t>(count_of(answer->get_header_value("Retry-After")), 1, longest_pause_seconds)));
    answer = client.Post(path, {{"Accept", draco_type}}, draco.data(), draco.size(), draco_type);
  }
  if (!answer) throw no_answer(origin_, answer.error());
  if (answer->status != 200) throw error_from(answer->status, answer->body);
  return {answer->body, statistics_from(answer->headers)};
}

void Remote::refine_levels(std::string_view draco, const proto::Parameters& parameters,
                           const std::function<void(const proto::Part&)>& on_part) const {
  httplib::Request request;
  request.method = "POST";
  request.path = prefix_ + "/v1/refine?" + proto::to_query(parameters);
  request.headers = {{"Accept", "multipart/mixed"}, {"Content-Type", draco_type}};
  request.body = std::string(draco);

  int status = 0;
  std::string refusal;
  std::string failure;  ///< a problem document that came as a part
  std::optional<proto::MultipartReader> reader;
  const auto take_part = [&](const proto::Part& part) {
    if (part.header("Content-Type") == "application/problem+json")
      failure = part.body;
    else
      on_part(part);
  };
  request.response_handler = [&](const httplib::Response& response) {
    status = response.status;
    if (status == 200) reader.emplace(response.get_header_value("Content-Type"), longest_part, take_part);
    return true;
  };
  request.content_receiver = [&](const char* data, size_t size, uint64_t, uint64_t) {
    if (reader)
      reader->feed({data, size});
    else
      refusal.append(data, size);
    return true;
  };

  httplib::Client client = connect(origin_, options_);
  try {
    const auto answer = client.send(request);
    if (!answer) throw no_answer(origin_, answer.error());
    if (status != 200) throw error_from(status, refusal);
    if (!failure.empty()) throw error_from(status, failure);
    reader->finish();
  } catch (const proto::Problem& problem) {  // of the reader
    throw ServerError(status, "", problem.what());
  }
}

std::string Remote::health(Health question) const {
  constexpr int longest_seconds = 3;
  httplib::Client client = connect(origin_, options_);
  client.set_connection_timeout(longest_seconds);
  client.set_read_timeout(longest_seconds);
  const auto answer = client.Get(prefix_ + (question == Health::ready ? "/ready" : "/health"));
  if (!answer) throw no_answer(origin_, answer.error());
  if (answer->status != 200) throw error_from(answer->status, answer->body);
  const json document = json::parse(answer->body, nullptr, false);
  if (!document.is_object() || !document.contains("status") || !document["status"].is_string())
    throw ServerError(answer->status, "", "What answers at " + origin_ + " is no papilio-server.");
  return document["status"];
}

}  // namespace papilio::client
