#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "proto/problem.h"
#include "server/work.h"

// Admission of requests to computing slots. The policy has four parts:
//
// 1. Slots. A fixed number of requests compute at once. One more, on the express slot, is a request of small predicted
//    work. So a small request never waits for a large one to end.
// 2. Order. The client with the least work so far has priority: start-time fair queuing of predicted work (Goyal, Vin,
//    Cheng, "Start-time Fair Queueing", SIGCOMM 1996). Among requests of one client, and of equal clients, the one with
//    the least work has priority. Requests age: later ones overtake a request only until they have received as much
//    work as its own. So none starves.
// 3. Yielding. Work can exceed its prediction. A request that has used up its time on the express slot returns it
// between
//    two steps, keeps its progress, and waits for another slot with the large requests.
// 4. Places. Large requests may take half of the waiting places; the other half is for small ones. When all places are
//    taken, the latest request of the client with the most waiting requests is refused.

namespace papilio::server {

/// Scheduler of a fixed number of concurrent computations, with a bounded queue. Thread-safe.
class Admission {
 public:
  using Question = std::function<bool()>;
  static constexpr std::chrono::milliseconds default_express_time{100};

  /// Admits `slots` > 0 concurrent requests, and one more on the express slot; up to `queue` wait. Work that is not
  /// certain to be small returns the express slot after `express_time`.
  Admission(int slots, int queue, std::chrono::milliseconds express_time = default_express_time);

  class Slot;

  /// Waits for a slot. The request counts in the share of `client`. Throws `Problem`: busy if there is no place to
  /// wait, or if the place is withdrawn; cancelled if `client_gone` is true while waiting (polled ten times a second)
  /// or when the slot is granted.
  [[nodiscard]] std::shared_ptr<Slot> enter(const std::string& client, Work work, const Question& client_gone);

  /// Returns the number of requests on slots, including the express slot.
  [[nodiscard]] int computing() const;
  /// Returns the number of requests without a slot, including those that returned one.
  [[nodiscard]] int waiting() const;
  /// Returns whether any further request would be refused, even a small one.
  [[nodiscard]] bool full() const;
  /// Throws `Problem` busy if any request of the client would be refused, even a small one. Called before a body is
  /// read.
  void refuse_when_full(const std::string& client) const;

  /// Returns the upper bound of the requests that have returned the express slot at any time.
  [[nodiscard]] static int most_paused(int queue) { return (queue + 1) / 2; }

 private:
  enum class Lane { none, ordinary, express };
  /// Work granted to a client. It exists while the client has requests, or has received more work than others.
  struct Account {
    uint64_t next_start = 0;  ///< start tag of the next request
    int requests = 0;         ///< requests that wait or compute
    int waiting = 0;
  };
  using Accounts = std::map<std::string, Account>;
  using Queue = std::list<Slot*>;

  // All functions but `yield` and `release` require the mutex. None allocates, except for the message of a refusal.

  /// Grants free slots to waiting requests.
  void dispatch();
  /// Returns the waiting request of highest priority; null if there is none.
  [[nodiscard]] Slot* first_waiting(bool small_only) const;
  void grant(Slot& slot, Lane lane);
  void join_queue(Slot& slot);
  /// Removes the slot from the queue, if it is in it.
  void leave_queue(Slot& slot);
  /// Refuses one waiting request, perhaps the newcomer, if the newcomer exceeds the places.
  void refuse_latest(const Slot& newcomer);
  /// Waits until the slot is granted or refused. Returns false, with the slot removed, if the client left first.
  bool wait_for_turn(Slot& slot, std::unique_lock<std::mutex>& lock, const Question& client_gone);
  void forget_settled_accounts();
  [[nodiscard]] uint64_t start_of(const Account& account) const;
  [[nodiscard]] bool is_full() const {
    return ordinary_ == slots_ && express_ == 1 && static_cast<int>(waiting_.size()) >= queue_;
  }
  [[nodiscard]] int large_places() const { return most_paused(queue_); }
  [[nodiscard]] proto::Problem busy() const;

  void yield(Slot& slot, const Question& client_gone);
  void release(Slot& slot);

  const int slots_;
  const int queue_;
  const std::chrono::milliseconds express_time_;
  mutable std::mutex mutex_;  ///< guards the fields that follow, and the fields of slots except their lane
  std::condition_variable changed_;
  int ordinary_ = 0;  ///< ordinary slots in use
  int express_ = 0;   ///< 1 while the express slot is in use
  int large_ = 0;     ///< large requests in the queue
  Queue waiting_;     ///< waiting requests in order of arrival
  Accounts accounts_;
  uint64_t virtual_time_ = 0;  ///< start tag of the request that was last granted an ordinary slot
  uint64_t given_ = 0;         ///< total work that was granted a slot
};

/// Right of a request to compute. The destructor returns it.
class Admission::Slot {
 public:
  Slot(Admission& admission, Work work) : admission_(admission), work_(work) {}
  ~Slot() { admission_.release(*this); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  /// Yields if necessary; call it often, between steps of the work. Returns at once, unless the express slot must be
  /// returned: then after another slot is granted, or the client has left. Thread-safe. Throws `Problem` busy if there
  /// is no place to wait.
  void take_turn(const Question& client_gone);

 private:
  friend class Admission;
  [[nodiscard]] bool is_large() const { return is_paused_ || work_.expected > small_work; }

  Admission& admission_;
  Work work_;
  Accounts::iterator account_{};  ///< account of the client; valid if `is_counted_`
  bool is_counted_ = false;
  std::atomic<Lane> lane_ = Lane::none;
  std::chrono::steady_clock::time_point since_;  ///< time at which the lane was granted
  bool is_refused_ = false;
  bool is_paused_ = false;  ///< whether it has computed before
  uint64_t rank_ = 0;       ///< rank in the queue; the lowest has priority
  Queue node_{this};        ///< node of the queue, kept here while the request does not wait
  Queue::iterator place_ = node_.begin();
};

}  // namespace papilio::server
