#pragma once

#include <sys/types.h>

namespace papilio::bench {

/// The papilio-server that was built beside this program, as a process of its own on a free port of loopback. Its
/// log goes to /dev/null.
class ServerProcess {
 public:
  /// Throws std::runtime_error when it does not start.
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
