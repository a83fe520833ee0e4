#include <benchmark/benchmark.h>

#include <memory>
#include <thread>

#include "papilio/refine.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// One refinement with two threads compared with one thread, and the gain of two independent threads of arithmetic on
// this machine at the same time.

namespace papilio::bench {
namespace {

void compute() {
  double x = 1;
  for (int i = 0; i < 20'000'000; ++i) {
    x = x * 0.999999 + 1e-6;
    benchmark::DoNotOptimize(x);
  }
}

}  // namespace

void add_threads() {
  for (const Tension tension : {Tension::off, Tension::soft}) {
    Options options;
    options.levels = 3;
    options.tension = tension;
    options.edges = false;
    const auto coarse = std::make_shared<Mesh>(build_mesh(test::real_mesh("elephant89k.drc")));
    const auto refinement = [coarse, options](int threads) {
      return [=] {
        Mesh mesh = *coarse;
        return seconds([&] { (void)refine(std::move(mesh), options, {.threads = threads}); });
      };
    };
    add({.name = std::string("threads/two of one/uniform 3") + (tension == Tension::off ? "" : ", soft tension"),
         .divisor = 1e6,
         .unit = "ms",
         .ours = refinement(2),
         .peer = refinement(1)});
  }
  add({.name = "threads/two of one/plain arithmetic",
       .divisor = 1e6,
       .unit = "ms",
       .ours =
           [] {
             return seconds([] {
               std::thread other(compute);
               compute();
               other.join();
             });
           },
       .peer =
           [] {
             return seconds([] {
               compute();
               compute();
             });
           }});
}

}  // namespace papilio::bench
