#include "server/cache/result_cache.h"

#include <chrono>

#include "proto/problem.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

ResultCache::Answer ResultCache::get_or_make(const std::string& key, const std::function<Result(const Question&)>& make,
                                             const Question& client_gone) {
  for (;;) {
    if (Result kept = kept_.get(key)) return {std::move(kept), Source::kept};
    bool first = false;
    const std::shared_ptr<Flight> flight = join(key, first);
    if (first) return make_for_all(key, *flight, make, client_gone);
    if (Result result = wait_for(flight, client_gone)) return {std::move(result), Source::shared};
  }
}

std::shared_ptr<ResultCache::Flight> ResultCache::join(const std::string& key, bool& first) {
  const std::lock_guard lock(mutex_);
  const auto found = flights_.find(key);
  first = found == flights_.end();
  if (first) return flights_.emplace(key, std::make_shared<Flight>()).first->second;
  if (waiting_ >= most_waiting_)
    throw Problem(Code::busy,
                  "Too many requests are waiting for pending results. Try again after the time in "
                  "Retry-After.");
  ++waiting_;
  ++found->second->waiting;
  return found->second;
}

ResultCache::Answer ResultCache::make_for_all(const std::string& key, Flight& flight,
                                              const std::function<Result(const Question&)>& make,
                                              const Question& client_gone) {
  const auto abandoned = [&] {
    if (!client_gone()) return false;
    const std::lock_guard lock(mutex_);
    return flight.waiting == 0;
  };
  Result result;
  Source source = Source::kept;
  std::exception_ptr failure;
  try {
    result = kept_.get(key);  // another flight may have ended between the caller's look-up and this start
    if (result == nullptr) {
      source = Source::made;
      result = make(abandoned);
      kept_.put(key, result, result->bytes.size());
    }
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    flight.done = true;
    flight.result = result;
    flight.failure = failure;
    flights_.erase(key);
  }
  landed_.notify_all();
  if (failure) std::rethrow_exception(failure);
  return {std::move(result), source};
}

// Returns null if the computing request gave up: the result must then be computed again.
ResultCache::Result ResultCache::wait_for(const std::shared_ptr<Flight>& flight, const Question& client_gone) {
  std::unique_lock lock(mutex_);
  while (!landed_.wait_for(lock, std::chrono::milliseconds(100), [&] { return flight->done; })) {
    lock.unlock();
    const bool gone = client_gone();
    lock.lock();
    if (!gone || flight->done) continue;
    --waiting_;
    --flight->waiting;
    throw Problem(Code::cancelled, "The client went away while its result was made for another.");
  }
  --waiting_;
  if (!flight->failure) return flight->result;
  try {
    std::rethrow_exception(flight->failure);
  } catch (const Problem& problem) {
    if (problem.code() == Code::cancelled) return nullptr;
    throw;
  }
}

}  // namespace papilio::server
