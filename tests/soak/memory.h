#pragma once

#include <string>
#include <vector>

namespace papilio::soak {

/// The resident memory of the server, looked at while it has nothing to do.
class Memory {
 public:
  explicit Memory(int pid) : pid_(pid) {}

  /// Takes the average of a few samples; `warm` when the warm-up is over. Takes some thirteen seconds.
  void look(bool warm);
  /// MiB: averages of the first and of the last three looks after the warm-up. 0 where there are fewer than six.
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
