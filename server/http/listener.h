#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/parking.h"

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
  /// True while a connection waits for a thread.
  [[nodiscard]] bool others_wait() const;
  /// Runs the work on one of the threads, after what waits already. To be called from one of them.
  void enqueue(std::function<void()> work);
  /// Runs `resume` on one of the threads once the socket is ready (`Parking::park`). To be called from one of them.
  void park(int fd, short events, Parking::Clock::time_point deadline, std::function<void()> resume);

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace papilio::server
