#include <chrono>
#include <nlohmann/json.hpp>

#include "proto/multipart.h"
#include "proto/problem.h"
#include "tests/soak/kinds.h"

namespace papilio::soak {
namespace {

void refine_small(Client& client) {
  const Order& order = client.pick(client.world().small());
  const auto began = std::chrono::steady_clock::now();
  const httplib::Result answer = client.ask("POST", "/v1/refine?" + order.query, as_draco, *order.mesh);
  if (!client.expect(answer, {200, 429})) return;
  if (answer->status == 200)
    client.time(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  client.expect_mesh(answer, order.answer);
}

void refine_medium(Client& client) {
  const Order& order = client.pick(client.world().medium());
  const httplib::Result answer = client.ask("POST", "/v1/refine?" + order.query, as_draco, *order.mesh);
  if (client.expect(answer, {200, 429})) client.expect_mesh(answer, order.answer);
}

void refine_form(Client& client) {
  const Order& order = client.pick(client.world().small());
  const std::string levels = std::to_string(order.parameters.options.levels);
  const httplib::Result answer = client.ask(
      "/v1/refine", {{"mesh", *order.mesh, "a.drc", draco_type}, {"params", "{\"levels\": " + levels + "}", "", ""}});
  if (client.expect(answer, {200, 429})) client.expect_mesh(answer, {});
}

/// Expects the last mesh of a stream to equal the answer without streaming.
void refine_levels(Client& client) {
  const Order& order = client.pick(client.world().small());
  const httplib::Result answer = client.ask("POST", "/v1/refine?" + order.query,
                                            {{"Content-Type", draco_type}, {"Accept", "multipart/mixed"}}, *order.mesh);
  if (!client.expect(answer, {200, 429}) || answer->status != 200) return;
  try {
    std::vector<proto::BodyPart> parts;
    proto::MultipartReader reader(answer->get_header_value("Content-Type"), 1U << 30,
                                  [&](proto::BodyPart part) { parts.push_back(std::move(part)); });
    reader.feed(answer->body);
    reader.finish();
    if (parts.size() < 2 || parts.back().header("Content-Type") != "application/json")
      client.violate("a stream without its summary");
    else if (parts[parts.size() - 2].body != order.answer)
      client.violate("the stream's last mesh is another than the library makes");
  } catch (const proto::Problem& problem) {
    client.violate(std::string("a stream that cannot be read: ") + problem.what());
  }
}

void look(Client& client) {
  constexpr std::array paths{"/v1/info", "/health", "/ready", "/metrics", "/openapi.json"};
  const std::string path = client.pick(paths);
  const httplib::Result answer = client.ask(client.random()() % 4 == 0 ? "HEAD" : "GET", path);
  if (answer && answer->status == 503 &&
      path == "/ready")  // allowed under load; an answer to HEAD has no body to check
    client.count(503, "not_ready");
  else
    client.expect(answer, {200});
}

}  // namespace

std::vector<Kind> decent_kinds() {
  return {{"refine small", 2, refine_small},
          {"refine medium", 1, refine_medium},
          {"refine form", 1, refine_form},
          {"refine levels", 1, refine_levels},
          {"look", 1, look}};
}

}  // namespace papilio::soak
