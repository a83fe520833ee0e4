#include <nlohmann/json.hpp>

#include "proto/refinement.h"
#include "tests/soak/kinds.h"
#include "tests/soak/queries.h"

namespace papilio::soak {
namespace {

/// Uploads the mesh. Returns its path; empty if the server was busy.
std::string upload(Client& client, const std::string& mesh) {
  const httplib::Result answer = client.ask("POST", "/v1/meshes", as_draco, mesh);
  if (!client.expect(answer, {200, 201, 429}) || answer->status == 429) return {};
  const auto document = nlohmann::json::parse(answer->body, nullptr, false);
  if (!document.is_object() || "/v1/meshes/" + document.value("id", "") != answer->get_header_value("Location"))
    client.violate("a stored mesh whose Location is not its id");
  return answer->get_header_value("Location");
}

/// Requests one view twice: with the entity tag of the first answer, the second is 304.
void ask_twice(Client& client, const std::string& path, const std::string& mesh) {
  const std::string query = random_query(client.random(), 3);
  const httplib::Result answer = client.ask("GET", path + "/refined?" + query);
  if (!client.expect(answer, {200, 429}) || answer->status != 200) return;
  const auto parameters = proto::parse_query(fields_of(query));
  client.expect_mesh(answer, proto::Refinement(mesh, parameters, {}).run().bytes);
  const std::string tag = answer->get_header_value("ETag");
  const httplib::Result again = client.ask("GET", path + "/refined?" + query, {{"If-None-Match", tag}});
  if (client.expect(again, {304}) && !again->body.empty()) client.violate("304 with a body");
}

void walk_round(Client& client) {
  const std::string mesh = World::own_mesh(client.random());
  const std::string path = upload(client, mesh);
  if (path.empty()) return;
  for (unsigned views = client.random()() % 8; views > 0; --views) ask_twice(client, path, mesh);
  const httplib::Result same = client.ask("GET", path);
  if (client.expect(same, {200}) && same->body != mesh) client.violate("another mesh than was stored");
  client.expect(client.ask("GET", path, {{"Accept", "application/json"}}), {200, 429});
  const httplib::Result by_json =
      client.ask("POST", path + "/refined", {{"Content-Type", "application/json"}}, R"({"levels": 1})");
  if (client.expect(by_json, {200, 429})) client.expect_mesh(by_json, {});
  client.expect(client.ask("DELETE", path), {204});
  client.expect(client.ask("GET", path), {404});
  client.expect(client.ask("GET", path + "/refined"), {404});
}

/// Fills the store and the caches, so that the least recently used entries are evicted.
void hoard(Client& client) {
  const std::string path = upload(client, World::own_mesh(client.random()));
  if (path.empty()) return;
  const httplib::Result answer = client.ask("GET", path + "/refined?levels=4");
  if (client.expect(answer, {200, 429})) client.expect_mesh(answer, {});
}

/// Equal requests of many clients: answered from the cache or by one computation.
void share(Client& client) {
  const std::string path = upload(client, client.world().coarse());
  if (path.empty()) return;
  for (int i = 0; i < 4; ++i) {
    const Order& order = client.pick(client.world().small());
    if (order.mesh != &client.world().coarse()) continue;
    const httplib::Result answer = client.ask("GET", path + "/refined?" + order.query);
    if (client.expect(answer, {200, 429})) client.expect_mesh(answer, order.answer);
  }
}

}  // namespace

std::vector<Kind> stored_kinds() {
  return {{"stored views", 2, walk_round}, {"stored hoard", 1, hoard}, {"stored shared", 2, share}};
}

}  // namespace papilio::soak
