#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "server/heap.h"
#include "tests/bench/kept_connection.h"
#include "tests/bench/pairs.h"
#include "tests/bench/server_process.h"
#include "tests/support/real_mesh.h"

// Cost of HTTP: a request to the server over a persistent connection, compared with the same work in this process.

namespace papilio::bench {
namespace {

/// A server with a client, started on the first request: other rows run without a server.
class Service {
 public:
  std::string_view ask(std::string_view request) {
    if (!connection_) {
      server::set_up_heap(1);  // so that this process also keeps freed memory for the next request
      connection_.emplace(server_.emplace().port());
    }
    return connection_->ask(request);
  }

 private:
  std::optional<ServerProcess> server_;
  std::optional<KeptConnection> connection_;
};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// One refinement, repeated through the server and then without it, so that both sides see the same machine load. The
/// time of each side is its median. Rows request their sides separately: the other side's time is stored until then.
class Turns {
 public:
  Turns(std::shared_ptr<Service> service, std::string mesh, const std::string& levels, int times)
      : service_(std::move(service)),
        mesh_(std::move(mesh)),
        times_(times),
        parameters_(proto::parse_query({{"levels", levels}})),
        request_("POST /v1/refine?levels=" + levels +
                 " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/x-draco\r\nContent-Length: " +
                 std::to_string(mesh_.size()) + "\r\n\r\n" + mesh_) {}

  double with() { return next(with_); }
  double without() { return next(without_); }

 private:
  double next(std::vector<double>& side) {
    if (side.empty()) take();
    const double taken = side.back();
    side.pop_back();
    return taken;
  }

  void take() {
    std::string_view answer;
    with_.push_back(turn([&] { answer = service_->ask(request_); }));
    std::string made;
    without_.push_back(turn([&] { made = proto::Refinement(mesh_, parameters_, {}).run().bytes; }));
    if (answer != made) throw std::runtime_error("papilio-server answers with another mesh");
  }

  [[nodiscard]] double turn(const std::function<void()>& work) const {
    std::vector<double> taken(static_cast<size_t>(times_));
    for (double& time : taken) time = seconds(work);
    return median(std::move(taken));
  }

  const std::shared_ptr<Service> service_;
  const std::string mesh_;
  const int times_;
  const proto::Parameters parameters_;
  const std::string request_;
  std::vector<double> with_, without_;  ///< measured seconds, not yet returned
};

}  // namespace

void add_http() {
  const auto service = std::make_shared<Service>();
  const std::string mesh = proto::write_draco_exact(test::real_mesh("bunny600.obj"));
  for (const auto& [levels, times] : {std::pair<std::string, int>{"2", 7}, {"6", 1}}) {
    const auto turns = std::make_shared<Turns>(service, mesh, levels, times);
    add({.name = "http/bunny600.obj/levels=" + levels + ", peer: without",
         .divisor = 1e6,
         .unit = "ms",
         .ours = [turns] { return turns->with(); },
         .peer = [turns] { return turns->without(); }});
  }
}

}  // namespace papilio::bench
