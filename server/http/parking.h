#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace papilio::server {

/// Sockets whose clients have nothing to say yet: each costs a descriptor, and no thread. Any thread may use it.
class Parking {
 public:
  using Clock = std::chrono::steady_clock;

  /// Room for `most` > 0 sockets. Throws std::system_error when the system has no means for it.
  explicit Parking(size_t most);
  ~Parking();
  Parking(const Parking&) = delete;
  Parking& operator=(const Parking&) = delete;

  /// Calls `resume` once, from a thread of its own, when the socket is ready for `events` (of poll) or has failed, or
  /// when the deadline has passed. `resume` owns the socket: it is destroyed without a call when the parking is closed
  /// or full. When it is full the socket with the next deadline gives way.
  void park(int fd, short events, Clock::time_point deadline, std::function<void()> resume);
  /// Destroys what is parked, now and from now on.
  void close();

 private:
  struct Parked {
    int fd;
    Clock::time_point deadline;
    std::function<void()> resume;
  };

  void run();
  /// Until the next deadline, -1 for no end; nothing once it is closed.
  [[nodiscard]] std::optional<int> milliseconds_to_wait();
  /// Takes one out, with its deadline passed by now; empty when there is none, or it is closed, as is the next.
  [[nodiscard]] std::function<void()> take_overdue();
  [[nodiscard]] std::function<void()> take(uint64_t id);
  /// With the mutex held; empty when there is none.
  [[nodiscard]] std::function<void()> take_locked(uint64_t id);
  void wake() const;

  const size_t most_;
  const int epoll_;
  const int wake_;    ///< an eventfd
  std::mutex mutex_;  ///< guards all below
  std::map<uint64_t, Parked> parked_;
  std::set<std::pair<Clock::time_point, uint64_t>> deadlines_;
  uint64_t next_id_ = 1;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace papilio::server
