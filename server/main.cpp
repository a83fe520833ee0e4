#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "server/address_space.h"
#include "server/config.h"
#include "server/container_memory.h"
#include "server/cors.h"
#include "server/endpoints.h"
#include "server/heap.h"
#include "server/keys.h"
#include "server/log.h"

using namespace papilio::server;

namespace {

/// Blocks signals in every thread, so that only `sigtimedwait` receives them. Returns them.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // a lost client or store shows in the result of a call
  return signals;
}

/// Raises the limit of open files to its maximum: each silent connection takes one.
void raise_descriptor_limit() {
  constexpr rlim_t most = 65536;
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = std::max(limit.rlim_cur, std::min(limit.rlim_max, most));
  ::setrlimit(RLIMIT_NOFILE, &limit);  // a refusal keeps the old limit
}

/// Unblocks SIGTERM and SIGINT, so that a second one ends the program at once. SIGHUP stays blocked: a reload must not
/// cut the last requests.
void unblock_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

/// Reloads a part of the configuration; keeps the old one if it cannot be read.
void reload(std::string_view what, const std::function<void()>& read) {
  try {
    read();
    log_event("info", "reload", {{"what", std::string(what)}, {"done", "true"}});
  } catch (const std::exception& error) {
    log_event("error", "reload", {{"what", std::string(what)}, {"done", "false"}, {"reason", error.what()}});
  }
}

/// Waits for the signal that ends the program, and returns it. Calls `while_waiting` every second.
int wait_for_end(const sigset_t& signals, const Config& config, HttpServer& server, Keys* keys,
                 const std::function<void()>& while_waiting) {
  for (;;) {
    constexpr timespec second{1, 0};
    const int signal = sigtimedwait(&signals, nullptr, &second);
    if (signal < 0) {
      while_waiting();
      continue;
    }
    if (signal != SIGHUP) return signal;
    if (keys != nullptr) reload("keys", [&] { keys->reload(); });
    if (!config.http.tls_cert.empty()) reload("certificate", [&] { server.reload_certificate(); });
  }
}

int serve(const Config& config) {
  const sigset_t signals = block_signals();
  start_log(config.log_level, config.log_format);
  raise_descriptor_limit();
  limit_address_space(config);
  if (config.max_memory_bytes == 0 && config.container_memory_bytes > 0)
    bound_by_container(config.container_memory_bytes);
  set_up_heap(config.engine.slots + 1);  // includes the express slot
  const auto keys = config.keys.empty() ? nullptr : std::make_unique<Keys>(config.keys);
  const Cors cors(config.cors_origins);
  Engine engine(config.engine);
  HttpOptions http = config.http;
  if (keys) http.authorize = [&](const Request& request, Access access) { return keys->authorize(request, access); };
  http.decorate = [&](const Request& request, Response& response) { cors.decorate(request, response); };
  FreeMemory free_memory;
  http.on_finished = [&](const Finished& request) {
    free_memory.count_request();
    engine.metrics().count_request(request);
    log_request(request);
  };
  HttpServer server(http);
  add_endpoints(server, engine);
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
  log_event("info", "start",
            {{"version", PAPILIO_VERSION},
             {"slots", config.engine.slots},
             {"queue", config.engine.queue},
             {"store", std::string(engine.store().kind())},
             {"web", config.engine.web.empty() ? "none" : config.engine.web},
             {"samples", engine.samples().all().size()},
             {"keys", keys ? keys->size() : 0}});

  const int held_by_work = 2 * (config.engine.slots + config.engine.queue) + 1;  // includes the express slot
  if (held_by_work >= http.threads)
    log_event(
        "warning", "settings",
        {{"reason", "as many as --connections may wait for work, and then nothing else is answered; give more than " +
                        std::to_string(held_by_work)}});

  const int signal = wait_for_end(signals, config, server, keys.get(), [&] {
    if (engine.admission().computing() == 0) free_memory.give_back();
  });
  log_event("info", "draining", {{"signal", signal}, {"running", server.running()}});
  unblock_end_signals();
  const bool complete = server.drain(config.drain_seconds);
  listener.join();
  if (!listener_failure.empty()) throw std::runtime_error(listener_failure);
  log_event("info", "stopped", {{"complete", complete ? "true" : "false"}});
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
