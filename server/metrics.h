#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "proto/refinement.h"
#include "server/http/http.h"

namespace papilio::server {

/// What is read at the moment of the question.
struct Gauges {
  int slots = 0, computing = 0, waiting = 0;
  uint64_t result_cache_bytes = 0, mesh_cache_bytes = 0;
  HeldBytes held{};
  std::optional<uint64_t> store_meshes{}, store_bytes{};
};

/// Counters and histograms for Prometheus. Labels take few values each: routes as they were added, methods and codes
/// of closed lists. Any thread may use it.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  enum class Cache { results, meshes };
  void count_request(const Finished& request);
  /// One that came after the answer's status was sent.
  void count_problem(const std::string& code);
  /// One refinement carried out, to its end.
  void count_refinement(uint64_t faces_in, const proto::Statistics& made);
  void count_lookup(Cache cache, bool hit);
  /// A result that was made once for several requests.
  void count_shared();
  /// In seconds.
  void observe_wait(double waited);

  /// The exposition format, version 0.0.4.
  [[nodiscard]] std::string text(const Gauges& now);

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace papilio::server
