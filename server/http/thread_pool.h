#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

#include "server/container_memory.h"

namespace papilio::server {

/// Threads that begin when there is work for them and end when there has been none for a while. With a fixed number of
/// them each comes to hold, in malloc's cache for its thread, small pieces from everywhere: pages which then cannot go
/// back to the system.
class ThreadPool {
 public:
  /// At most `most` > 0 threads at once. The first begins here and stays, so that work is done though no further one
  /// can begin. Throws std::system_error when it cannot.
  ThreadPool(size_t most, std::chrono::milliseconds idle_time);
  ~ThreadPool() { shutdown(); }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// `work` must not throw.
  void enqueue(std::function<void()> work);
  /// True while there is work that has to wait for a thread to be done with another.
  [[nodiscard]] bool has_waiting() const { return waiting_; }
  /// Returns when all work is done. None may be added afterwards.
  void shutdown();

 private:
  struct Thread {
    StackSpace stack;  ///< until it is joined
    std::thread thread;
  };
  using Threads = std::list<Thread>;

  void begin_thread();  ///< with the mutex held
  void run(Threads::iterator self, bool stays);
  void count_waiting() { waiting_ = work_.size() > free_; }  ///< with the mutex held

  const size_t most_;
  const std::chrono::milliseconds idle_time_;
  std::atomic<bool> waiting_ = false;
  std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::deque<std::function<void()>> work_;
  size_t free_ = 0;  ///< threads that wait for work, or are about to
  Threads threads_;
  Threads ended_;  ///< to be joined
  bool closed_ = false;
};

}  // namespace papilio::server
