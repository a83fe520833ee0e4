#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "proto/refinement.h"
#include "server/http/http.h"

namespace papilio::server {

/// Values read at the time of a scrape.
struct Gauges {
  int slots = 0, computing = 0, waiting = 0;
  uint64_t result_cache_bytes = 0, mesh_cache_bytes = 0;
  HeldBytes held{};
  std::optional<uint64_t> store_meshes{}, store_bytes{};
};

/// Counters and histograms for Prometheus. Labels have few values each: paths of routes, methods and codes of closed
/// lists. Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  enum class Cache { results, meshes };
  void count_request(const Finished& request);
  /// Counts a problem that arose after the answer's status was sent.
  void count_problem(const std::string& code);
  /// Counts a completed refinement.
  void count_refinement(uint64_t faces_in, const proto::Statistics& made);
  void count_lookup(Cache cache, bool hit);
  /// Counts a request that shared the computation of another.
  void count_shared();
  /// Records a wait for a slot, in seconds.
  void observe_wait(double waited);

  /// Returns the metrics in the exposition format, version 0.0.4.
  [[nodiscard]] std::string text(const Gauges& now);

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace papilio::server
