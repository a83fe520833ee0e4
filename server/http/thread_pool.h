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

/// Pool of threads that start on demand and end when idle. Threads of a fixed number would retain small blocks from
/// everywhere in malloc's thread caches, whose pages could not return to the system.
class ThreadPool {
 public:
  /// Runs at most `most` > 0 threads. Starts a permanent one, so that work is done even if no further thread can start.
  /// Throws std::system_error if it cannot start.
  ThreadPool(size_t most, std::chrono::milliseconds idle_time);
  ~ThreadPool() { shutdown(); }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Queues work, which must not throw.
  void enqueue(std::function<void()> work);
  /// Returns whether work waits for a thread.
  [[nodiscard]] bool has_waiting() const { return waiting_; }
  /// Waits until all work is done. No work may be added afterwards.
  void shutdown();

 private:
  struct Thread {
    StackSpace stack;  ///< stack, until the thread is joined
    std::thread thread;
  };
  using Threads = std::list<Thread>;

  void begin_thread();  ///< requires the mutex
  void run(Threads::iterator self, bool stays);
  void count_waiting() { waiting_ = work_.size() > free_; }  ///< requires the mutex

  const size_t most_;
  const std::chrono::milliseconds idle_time_;
  std::atomic<bool> waiting_ = false;
  std::mutex mutex_;  ///< guards the fields that follow
  std::condition_variable changed_;
  std::deque<std::function<void()>> work_;
  size_t free_ = 0;  ///< threads that wait for work, or are about to
  Threads threads_;
  Threads ended_;  ///< threads to be joined
  bool closed_ = false;
};

}  // namespace papilio::server
