#pragma once

#include <string>
#include <vector>

namespace papilio::soak {

/// Resident memory of the server, sampled while it is idle.
class Memory {
 public:
  explicit Memory(int pid) : pid_(pid) {}

  /// Adds the mean of a few samples; `warm`: the warm-up is over. Takes about 13 seconds.
  void look(bool warm);
  /// Means of the first and of the last three samples after the warm-up, in MiB; 0 if there are fewer than six.
  [[nodiscard]] double at_start() const;
  [[nodiscard]] double at_end() const;
  [[nodiscard]] double growth() const { return at_start() > 0 ? at_end() / at_start() - 1 : 0; }
  void print() const;

 private:
  [[nodiscard]] double resident() const;

  int pid_;
  std::vector<double> warm_up_, warm_;
};

}  // namespace papilio::soak
