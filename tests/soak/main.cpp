#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "client/mesh_file/file_bytes.h"
#include "tests/soak/kinds.h"
#include "tests/soak/memory.h"
#include "tests/soak/pace.h"

// papilio-soak: runs all kinds of clients at once against a server on loopback. At intervals all clients pause while
// the memory of the server is sampled. The exit status is 0 if there was no failure, else 1.

namespace papilio::soak {
namespace {

using Clock = std::chrono::steady_clock;

struct Settings {
  int port = 0;
  int pid = 0;
  double seconds = 60;
  std::string mesh;
  uint64_t max_body_bytes = 0;
  double most_growth = 0;  ///< upper bound of the growth of memory, as a share; 0: no bound
  uint32_t seed = 1;
};

void take_turns(Client& client, Pace& pace, void (*turn)(Client&)) {
  while (pace.begin_turn()) {
    try {
      turn(client);
    } catch (const std::exception& error) {
      client.violate(std::string("the client itself failed: ") + error.what());
    }
    pace.end_turn();
    std::this_thread::sleep_for(std::chrono::milliseconds(client.random()() % 50));
  }
}

std::vector<Kind> all_kinds() {
  std::vector<Kind> all;
  for (const auto& some : {decent_kinds(), stored_kinds(), wrong_kinds(), rude_kinds()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// Blocks until the time is over.
void watch_memory(const Settings& settings, Pace& pace, Memory& memory) {
  const auto began = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  const double warm_up = std::max(20.0, 0.3 * settings.seconds);  // caches fill slowly
  const double between = std::max(8.0, settings.seconds / 30);
  while (elapsed() < settings.seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(between));
    pace.keep_still();
    memory.look(elapsed() > warm_up);
    pace.go_on();
  }
}

int run(const Settings& settings) {
  const World world(settings.port, settings.max_body_bytes, client::read_bytes(settings.mesh, 1U << 30), settings.seed);
  Tally tally;
  Pace pace;
  Memory memory(settings.pid);
  std::vector<std::thread> threads;
  for (const Kind& kind : all_kinds())
    for (int i = 0; i < kind.clients; ++i)
      threads.emplace_back([&, kind, seed = settings.seed + static_cast<uint32_t>(threads.size())] {
        Client client(world, tally, kind.name, seed);
        take_turns(client, pace, kind.turn);
      });
  watch_memory(settings, pace, memory);
  pace.end();
  for (std::thread& thread : threads) thread.join();
  tally.print();
  memory.print();
  const bool grows = settings.most_growth > 0 && memory.growth() > settings.most_growth;
  if (grows) std::printf("WRONG: memory grows by more than %.1f %%\n", 100 * settings.most_growth);
  return tally.violations() == 0 && !grows ? 0 : 1;
}

}  // namespace
}  // namespace papilio::soak

int main(int argc, char** argv) {
  papilio::soak::Settings settings;
  CLI::App app{"All kinds of clients at once against a papilio-server on loopback."};
  app.add_option("--port", settings.port, "Its port")->required();
  app.add_option("--pid", settings.pid, "Its process, whose memory is watched")->required();
  app.add_option("--seconds", settings.seconds, "How long");
  app.add_option("--mesh", settings.mesh, "The coarse mesh, Draco")->required();
  app.add_option("--max-body-bytes", settings.max_body_bytes, "Its limit on bodies")->required();
  app.add_option("--most-growth", settings.most_growth, "Share by which its memory may grow after the warm-up; 0: any");
  app.add_option("--seed", settings.seed, "What the clients' choices come from");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return papilio::soak::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "papilio-soak: %s\n", error.what());
    return 1;
  }
}
