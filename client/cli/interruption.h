#pragma once

namespace papilio::client {

/// While it lives, the first SIGINT or SIGTERM asks to stop instead of ending the program; the second ends it. One at a
/// time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Returns whether a signal came since the construction.
  [[nodiscard]] static bool is_asked();
};

}  // namespace papilio::client
