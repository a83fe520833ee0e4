#pragma once

namespace papilio::client {

/// Handler of SIGINT and SIGTERM during its lifetime: the first signal requests to stop, the second ends the program.
/// Only one may exist at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Returns whether a signal has arrived since the construction.
  [[nodiscard]] static bool is_asked();
};

}  // namespace papilio::client
