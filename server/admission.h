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

// Which request computes next. The policy has four parts:
//
// 1. Slots. A fixed number of requests compute at once, and one more where its work is expected to be small: the
//    express slot. So a small request never waits for a large one to end.
// 2. Order. The client with the least work so far goes first: start-time fair queuing of predicted work (Goyal, Vin,
//    Cheng, "Start-time Fair Queueing", SIGCOMM 1996). Among the requests of one client, and of equal clients, the one
//    with the least work goes first. Requests age: one is passed over by later ones only until these were given as
//    much work as its own. So none starves.
// 3. Yielding. Work can be larger than expected. A request that has used up its time on the express slot gives the slot
//    back between two steps, keeps what it has made, and waits for another slot with the large ones.
// 4. Places. Large requests may take half of the waiting places, the other half is for small ones. When there is no
//    place left, the latest request of the client with the most waiting ones is refused.

namespace papilio::server {

/// Lets a fixed number of requests compute at once, and bounds how many wait. Threads may share it.
class Admission {
 public:
  using Question = std::function<bool()>;
  static constexpr std::chrono::milliseconds default_express_time{100};

  /// `slots` > 0 requests compute at once, besides one on the express slot; up to `queue` wait. Work that is not
  /// certain to be small gives the express slot back after `express_time`.
  Admission(int slots, int queue, std::chrono::milliseconds express_time = default_express_time);

  class Slot;

  /// Waits for a slot. `client`: whose share of the slots the request takes. Throws `Problem`: busy when there is no
  /// place to wait, or the place is taken away; cancelled when `client_gone` says so while waiting (asked ten times a
  /// second) or once the slot is there.
  [[nodiscard]] std::shared_ptr<Slot> enter(const std::string& client, Work work, const Question& client_gone);

  /// Requests on slots, the express slot included.
  [[nodiscard]] int computing() const;
  /// Requests without a slot, those that gave one back included.
  [[nodiscard]] int waiting() const;
  /// No request that came now would be let in, however small.
  [[nodiscard]] bool full() const;
  /// Throws `Problem` busy when the client's request would be refused, however small: to be called before a body is
  /// read that would only be held for nothing.
  void refuse_when_full(const std::string& client) const;

  /// The most requests that may have given the express slot back at once.
  [[nodiscard]] static int most_paused(int queue) { return (queue + 1) / 2; }

 private:
  enum class Lane { none, ordinary, express };
  /// What a client was given, in units of work. It exists while the client has requests, or more than others had.
  struct Account {
    uint64_t next_start = 0;  ///< start tag of the next request
    int requests = 0;         ///< that wait or compute
    int waiting = 0;
  };
  using Accounts = std::map<std::string, Account>;
  using Queue = std::list<Slot*>;

  // With the mutex held, all but `yield` and `release`. None allocates, but for the words of a refusal.

  /// Gives free slots to waiting requests.
  void dispatch();
  /// Null when none waits.
  [[nodiscard]] Slot* first_waiting(bool small_only) const;
  void grant(Slot& slot, Lane lane);
  void join_queue(Slot& slot);
  /// Does nothing when the slot is not in the queue.
  void leave_queue(Slot& slot);
  /// Refuses one waiting request when the newcomer, which may be that one, is one too many.
  void refuse_latest(const Slot& newcomer);
  /// Waits until the slot is granted or refused. False when the client went away first; it has then left the queue.
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
  mutable std::mutex mutex_;  ///< guards all below, and what the slots have but their lane
  std::condition_variable changed_;
  int ordinary_ = 0;  ///< ordinary slots in use
  int express_ = 0;   ///< 1 while the express slot is in use
  int large_ = 0;     ///< large requests in the queue
  Queue waiting_;     ///< in the order in which they came
  Accounts accounts_;
  uint64_t virtual_time_ = 0;  ///< start tag of the request that was given an ordinary slot last
  uint64_t given_ = 0;         ///< all work that was given a slot
};

/// A request's right to compute, given back when it is destroyed.
class Admission::Slot {
 public:
  Slot(Admission& admission, Work work) : admission_(admission), work_(work) {}
  ~Slot() { admission_.release(*this); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  /// To be called often, between steps of the work: returns at once unless the express slot must be given back, and
  /// then once there is another slot, or the client went away. Any thread may call it. Throws `Problem` busy when there
  /// is no place to wait.
  void take_turn(const Question& client_gone);

 private:
  friend class Admission;
  [[nodiscard]] bool is_large() const { return is_paused_ || work_.expected > small_work; }

  Admission& admission_;
  Work work_;
  Accounts::iterator account_{};  ///< once `is_counted_`
  bool is_counted_ = false;
  std::atomic<Lane> lane_ = Lane::none;
  std::chrono::steady_clock::time_point since_;  ///< when the lane was granted
  bool is_refused_ = false;
  bool is_paused_ = false;  ///< has computed before
  uint64_t rank_ = 0;       ///< the least goes first
  Queue node_{this};        ///< its place in the queue, here while it does not wait
  Queue::iterator place_ = node_.begin();
};

}  // namespace papilio::server
