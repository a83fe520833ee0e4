#include <array>

#include "tests/soak/kinds.h"

namespace papilio::soak {
namespace {

struct Wrong {
  const char *method, *path, *type;
  bool with_mesh;
  int status;
};

void ask_wrongly(Client& client) {
  constexpr std::array wrongs{
      Wrong{"POST", "/v1/refine?level=1", draco_type, true, 400},
      Wrong{"POST", "/v1/refine?levels=-1", draco_type, true, 400},
      Wrong{"POST", "/v1/refine?levels=1&levels=1", draco_type, true, 400},
      Wrong{"POST", "/v1/refine?view.eye=0,0,0&view.target=0,0,0", draco_type, true, 400},
      Wrong{"POST", "/v1/refine?levels=%zz", draco_type, true, 400},
      Wrong{"POST", "/v1/refine", "text/html", true, 415},
      Wrong{"POST", "/v1/refine", draco_type, false, 422},
      Wrong{"GET", "/v1/refine", "", false, 405},
      Wrong{"DELETE", "/v1/info", "", false, 405},
      Wrong{"GET", "/v1/nothing", "", false, 404},
      Wrong{"GET", "/v1/meshes/0/refined", "", false, 404},
  };
  const Wrong& wrong = client.pick(wrongs);
  httplib::Headers headers;
  if (*wrong.type != '\0') headers.emplace("Content-Type", wrong.type);
  client.expect(client.ask(wrong.method, wrong.path, headers, wrong.with_mesh ? client.world().coarse() : ""),
                {wrong.status, 429});
}

/// The only server error that is provoked.
void ask_too_much(Client& client) {
  const std::string levels = std::to_string(8 + client.random()() % 3);
  client.expect(
      client.ask("POST", "/v1/refine?levels=" + levels, {{"Content-Type", draco_type}}, client.world().coarse()),
      {507, 429});
}

/// Sends a mesh with a few changed bytes, which may still be valid.
void send_damaged(Client& client) {
  std::string mesh = client.world().coarse();
  for (unsigned times = 1 + client.random()() % 8; times > 0; --times)
    mesh[client.random()() % mesh.size()] = static_cast<char>(client.random()());
  if (client.random()() % 3 == 0) mesh.resize(client.random()() % mesh.size());
  const httplib::Result answer = client.ask("POST", "/v1/refine?levels=1", {{"Content-Type", draco_type}}, mesh);
  if (client.expect(answer, {200, 413, 422, 429, 507})) client.expect_mesh(answer, {});
}

}  // namespace

std::vector<Kind> wrong_kinds() {
  return {{"wrong requests", 1, ask_wrongly}, {"too much", 1, ask_too_much}, {"damaged meshes", 1, send_damaged}};
}

}  // namespace papilio::soak
