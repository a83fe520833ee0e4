#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "proto/refinement.h"
#include "server/cache/lru.h"

namespace papilio::server {

/// Cache of results by entity tag, bounded in bytes. Concurrent requests for one result share its computation: later
/// ones wait for it. Thread-safe.
class ResultCache {
 public:
  using Result = std::shared_ptr<const proto::EncodedLevel>;
  using Question = std::function<bool()>;

  /// Bounds the requests that wait for results of others by `most_waiting`, as each occupies a connection's thread.
  ResultCache(uint64_t budget, int most_waiting) : kept_(budget), most_waiting_(most_waiting) {}

  /// Source of an answer.
  enum class Source {
    kept,    ///< the cache
    shared,  ///< the computation of another request
    made,    ///< the computation of this request
  };
  struct Answer {
    Result result;
    Source source;
  };

  /// Returns the cached result, or waits for another request's computation, or calls `make`. `make` polls `abandoned`
  /// between its steps, which is true if no request waits for the result any more. Its exceptions reach all waiting
  /// requests. Throws `Problem` cancelled if `client_gone` is true while waiting (polled ten times a second).
  [[nodiscard]] Answer get_or_make(const std::string& key, const std::function<Result(const Question& abandoned)>& make,
                                   const Question& client_gone);

  /// Returns the cached result; null if there is none.
  [[nodiscard]] Result get(const std::string& key) { return kept_.get(key); }
  [[nodiscard]] uint64_t bytes() const { return kept_.bytes(); }
  [[nodiscard]] uint64_t size() const { return kept_.size(); }

 private:
  /// Computation of one result.
  struct Flight {
    int waiting = 0;  ///< number of waiting requests
    bool done = false;
    Result result;
    std::exception_ptr failure;
  };

  Answer make_for_all(const std::string& key, Flight& flight, const std::function<Result(const Question&)>& make,
                      const Question& client_gone);
  [[nodiscard]] std::shared_ptr<Flight> join(const std::string& key, bool& first);
  [[nodiscard]] Result wait_for(const std::shared_ptr<Flight>& flight, const Question& client_gone);

  Lru<const proto::EncodedLevel> kept_;
  const int most_waiting_;
  std::mutex mutex_;
  std::condition_variable landed_;
  std::map<std::string, std::shared_ptr<Flight>> flights_;  ///< computations, guarded by mutex_, as are their fields
  int waiting_ = 0;                                         ///< waiting requests of all flights, guarded by mutex_
};

}  // namespace papilio::server
