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

/// Results under their entity tags, up to a number of bytes. What is asked for while it is being made is made once:
/// whoever comes later waits for it. Any thread may use it.
class ResultCache {
 public:
  using Result = std::shared_ptr<const proto::EncodedLevel>;
  using Question = std::function<bool()>;

  /// At most `most_waiting` requests wait for results that others make: each holds a connection's thread.
  ResultCache(uint64_t budget, int most_waiting) : kept_(budget), most_waiting_(most_waiting) {}

  /// How an answer was come by.
  enum class Source {
    kept,    ///< from the cache
    shared,  ///< from another request that was making it
    made,    ///< by this one
  };
  struct Answer {
    Result result;
    Source source;
  };

  /// `make` is given a question to ask between its steps: whether nobody waits for the result any more. What it throws
  /// reaches everybody who waits. Throws `Problem` cancelled when `client_gone` (asked ten times a second) says so
  /// while waiting.
  [[nodiscard]] Answer get_or_make(const std::string& key, const std::function<Result(const Question& abandoned)>& make,
                                   const Question& client_gone);

  /// Null when it is not kept.
  [[nodiscard]] Result get(const std::string& key) { return kept_.get(key); }
  [[nodiscard]] uint64_t bytes() const { return kept_.bytes(); }
  [[nodiscard]] uint64_t size() const { return kept_.size(); }

 private:
  /// One result in the making.
  struct Flight {
    int waiting = 0;  ///< requests besides the one that makes it
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
  std::map<std::string, std::shared_ptr<Flight>> flights_;  ///< guarded by mutex_, as are the flights
  int waiting_ = 0;                                         ///< guarded by mutex_: for all flights together
};

}  // namespace papilio::server
