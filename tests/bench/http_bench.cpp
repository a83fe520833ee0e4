#include <httplib.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/bench/pairs.h"
#include "tests/bench/server_process.h"
#include "tests/support/real_mesh.h"

// What HTTP costs: a request to the real server over a connection that is kept, against the same work in this process.

namespace papilio::bench {
namespace {

/// A server with a client; begun with the first request, so that other rows go without.
class Service {
 public:
  double ask(const std::string& path, const std::string& mesh) {
    if (!client_) client_.emplace("127.0.0.1", server_.emplace().port());
    client_->set_keep_alive(true);
    client_->set_tcp_nodelay(true);
    return seconds([&] {
      const auto answer = client_->Post(path, mesh, "application/x-draco");
      if (!answer || answer->status != 200) throw std::runtime_error("papilio-server does not answer as it should");
    });
  }

 private:
  std::optional<ServerProcess> server_;
  std::optional<httplib::Client> client_;
};

}  // namespace

void add_http() {
  const auto service = std::make_shared<Service>();
  const auto mesh = std::make_shared<std::string>(proto::write_draco_exact(test::real_mesh("bunny600.obj")));
  for (const std::string levels : {"2", "6"}) {
    const proto::Parameters parameters = proto::parse_query({{"levels", levels}});
    add({.name = "http/bunny600.obj/levels=" + levels + ", peer: without",
         .divisor = 1e6,
         .unit = "ms",
         .ours = [service, mesh, levels] { return service->ask("/v1/refine?levels=" + levels, *mesh); },
         .peer = [mesh,
                  parameters] { return seconds([&] { (void)proto::Refinement(*mesh, parameters, {}).run(); }); }});
  }
}

}  // namespace papilio::bench
