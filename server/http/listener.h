#pragma once

#include <functional>
#include <memory>
#include <string>

namespace papilio::server {

/// Listens, accepts, and hands each connection to one of a bounded number of threads. The only place that knows
/// cpp-httplib: of it only the listening socket and the accepting loop are used. A request is never shown to it; see
/// head.h and body.h for why.
class Listener {
 public:
  /// `serve` is called with each accepted socket, which it owns, on one of at most `threads` threads.
  Listener(int threads, std::function<void(int fd)> serve);
  ~Listener();

  /// Returns the port. Throws std::runtime_error, naming host and port.
  int open(const std::string& host, int port);
  /// Accepts until `close`; returns when every `serve` has. Throws std::runtime_error when accepting fails.
  void run();
  /// Takes no further connections, whether `run` was called yet or not. Any thread may call it, any number of
  /// times.
  void close();
  [[nodiscard]] bool closed() const;
  /// True while an accepted connection waits for a thread: an idle one should then make room.
  [[nodiscard]] bool others_wait() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace papilio::server
