#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>

#include "server/config.h"
#include "server/log.h"
#include "server/service.h"

using namespace papilio::server;

namespace {

/// The signals that end the program; blocked in every thread, so that only `sigwait` sees them.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

int serve(const Config& config) {
  const sigset_t stop_signals = block_stop_signals();
  start_log(config.log_level);
  HttpOptions http = config.http;
  http.on_finished = log_request;
  Service service(config.limits, http.max_body_bytes, config.slots, config.queue);
  HttpServer server(http);
  service.add_routes(server);
  const int port = server.bind();
  std::string listener_failure;
  std::thread listener([&] {
    try {
      server.run();
    } catch (const std::exception& error) {
      listener_failure = error.what();
      kill(getpid(), SIGTERM);  // wakes the wait below
    }
  });
  std::cout << "listening on " << (http.tls_cert.empty() ? "http" : "https") << "://"
            << (http.host.find(':') == std::string::npos ? http.host : '[' + http.host + ']') << ':' << port
            << std::endl;
  spdlog::info("msg=start version={} slots={} queue={}", PAPILIO_VERSION, config.slots, config.queue);

  int signal = 0;
  sigwait(&stop_signals, &signal);
  spdlog::info("msg=draining signal={} running={}", signal, server.running());
  pthread_sigmask(SIG_UNBLOCK, &stop_signals, nullptr);  // a second signal ends the program at once
  const bool complete = server.drain(config.drain_seconds);
  listener.join();
  if (!listener_failure.empty()) throw std::runtime_error(listener_failure);
  spdlog::info("msg=stopped complete={}", complete);
  return complete ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const ConfigOutcome outcome = parse_config(argc, argv);
    return outcome.exit ? outcome.status : serve(outcome.config);
  } catch (const std::exception& error) {
    std::cerr << "papilio-server: " << error.what() << '\n';
    return 1;
  }
}
