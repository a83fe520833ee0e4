#pragma once

#include <sys/types.h>

namespace papilio::bench {

/// Process of the papilio-server built with this program, on a free port of loopback. Its log is discarded.
class ServerProcess {
 public:
  /// Throws std::runtime_error if the server does not start.
  ServerProcess();
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  pid_t pid_ = -1;
  int port_ = 0;
};

}  // namespace papilio::bench
