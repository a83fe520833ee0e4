#pragma once

#include <functional>
#include <string>

namespace papilio::bench {

/// One row of the table: the same work done by us and by a peer, timed in turns in one process.
///
/// `ours` and `peer` do the work once and return the seconds that count, so that each can leave out its own
/// preparation.
struct Pair {
  std::string name;
  double divisor = 1;  ///< what the time is divided by: the number of output triangles, say
  std::string unit;    ///< of the quotient, starting from nanoseconds: "ns/triangle"
  std::function<double()> ours, peer;
};

/// Adds a row. Called at start, before the benchmarks run.
void add(Pair pair);

/// Seconds that the work takes.
double seconds(const std::function<void()>& work);

/// Each file of cases adds its own.
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
