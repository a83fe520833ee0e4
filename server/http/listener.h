#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/parking.h"

namespace papilio::server {

/// Listener that accepts connections and passes each to one of a bounded number of threads. Only this uses cpp-httplib:
/// its listening socket and accepting loop, but none of its parsers (head.h, body.h).
class Listener {
 public:
  /// Calls `serve` with each accepted socket, which it owns, on one of at most `threads` threads.
  Listener(int threads, std::function<void(int fd)> serve);
  ~Listener();

  /// Listens; returns the port. Throws std::runtime_error with host and port.
  int open(const std::string& host, int port);
  /// Accepts until close(); returns when every call of `serve` has. Throws std::runtime_error if accepting fails.
  void run();
  /// Stops accepting, before or after run() was called. Thread-safe and idempotent.
  void close();
  [[nodiscard]] bool closed() const;
  /// Returns whether a connection waits for a thread.
  [[nodiscard]] bool others_wait() const;
  /// Runs the work on one of the threads, after waiting work. Call on one of the threads.
  void enqueue(std::function<void()> work);
  /// Runs `resume` on one of the threads once the socket is ready (`Parking::park`). Call on one of the threads.
  void park(int fd, short events, Parking::Clock::time_point deadline, std::function<void()> resume);

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace papilio::server
