#pragma once

#include <functional>
#include <string>

namespace papilio::bench {

/// One row of the table: equal work by us and by a peer, timed alternately in one process.
///
/// `ours` and `peer` do the work once and return its seconds without their preparation.
struct Pair {
  std::string name;
  double divisor = 1;  ///< of the time, for example the number of output triangles
  std::string unit;    ///< of the quotient, starting from nanoseconds: "ns/triangle"
  std::function<double()> ours, peer;
};

/// Adds a row. Must be called before the benchmarks run.
void add(Pair pair);

/// Returns the seconds of the work.
double seconds(const std::function<void()>& work);

/// Each adds the rows of its file.
void add_uniform();
void add_adaptive();
void add_limits();
void add_threads();
void add_draco();
void add_service();
void add_view_change();
void add_http();
void add_scene();

}  // namespace papilio::bench
