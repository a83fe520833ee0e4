#include "tests/soak/client.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto/draco_reader.h"
#include "proto/problem.h"

namespace papilio::soak {
namespace {

constexpr int longest_answer_seconds = 120;

/// Returns what is wrong with a refusal; empty if nothing is.
std::string fault_of_problem(const httplib::Response& answer, std::string& code) {
  if (answer.get_header_value("Content-Type") != "application/problem+json") return "a refusal that is no problem";
  const auto document = nlohmann::json::parse(answer.body, nullptr, false);
  if (!document.is_object() || document.value("status", 0) != answer.status) return "a problem of another status";
  code = document.value("code", "");
  if (document.value("request_id", "") != answer.get_header_value("X-Request-Id"))
    return "a problem of another request";
  if (document.value("detail", "").size() < 20) return "a problem that says nothing";
  if (answer.status == 429 && !answer.has_header("Retry-After")) return "429 without Retry-After";
  return {};
}

}  // namespace

Client::Client(const World& world, Tally& tally, std::string kind, uint32_t seed)
    : world_(world), tally_(tally), kind_(std::move(kind)), random_(seed), http_("127.0.0.1", world.port()) {
  http_.set_keep_alive(true);
  http_.set_tcp_nodelay(true);
  http_.set_read_timeout(longest_answer_seconds);
}

httplib::Result Client::ask(const std::string& method, const std::string& path, const httplib::Headers& headers,
                            const std::string& body) {
  httplib::Request request;
  request.method = method;
  request.path = path;
  request.headers = headers;
  request.body = body;
  httplib::Result answer = http_.send(request);
  return answer ? std::move(answer) : http_.send(request);
}

httplib::Result Client::ask(const std::string& path, const httplib::MultipartFormDataItems& form) {
  httplib::Result answer = http_.Post(path, form);
  return answer ? std::move(answer) : http_.Post(path, form);
}

bool Client::expect(const httplib::Result& answer, std::initializer_list<int> allowed) {
  if (!answer) {
    violate("no answer: " + httplib::to_string(answer.error()));
    return false;
  }
  std::string code;
  std::string fault;
  if (answer->status >= 400) fault = fault_of_problem(*answer, code);
  if (std::ranges::find(allowed, answer->status) == allowed.end()) fault = "an answer that is not allowed here";
  if (fault.empty()) {
    count(answer->status, code);
    return true;
  }
  violate(fault + ": " + std::to_string(answer->status) + " " + answer->body.substr(0, 300));
  return false;
}

void Client::expect_mesh(const httplib::Result& answer, std::string_view bytes) {
  if (!answer || answer->status != 200) return;
  if (!bytes.empty() && answer->body != bytes) violate("other bytes than the library makes");
  try {
    const size_t faces = proto::read_draco(answer->body, {.max_input_faces = 100'000'000}).triangles.size();
    if (std::to_string(faces) != answer->get_header_value("Papilio-Faces")) violate("Papilio-Faces is not true");
  } catch (const proto::Problem& problem) {
    violate(std::string("an answer that cannot be read: ") + problem.what());
  }
}

}  // namespace papilio::soak
