#include <memory>

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// A complete request, Draco to Draco: an adaptive answer compared with the uniform answer of the same mesh and levels.

namespace papilio::bench {

void add_service() {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const auto draco = std::make_shared<std::string>(proto::write_draco_exact(test::real_mesh(name)));
    const auto time_of = [draco](const proto::QueryFields& fields) {
      return [draco, parameters = proto::parse_query(fields)] {
        return seconds([&] { (void)proto::Refinement(*draco, parameters, {}).run(); });
      };
    };
    add({.name = "request/" + std::string(name) + "/adaptive, peer: uniform",
         .divisor = 1e6,
         .unit = "ms",
         .ours = time_of({{"levels", "3"}, {"flatness", "0.8,0.9,0.95"}}),
         .peer = time_of({{"levels", "3"}})});
  }
}

}  // namespace papilio::bench
