#include "server/http/thread_pool.h"

#include <system_error>
#include <utility>

namespace papilio::server {

ThreadPool::ThreadPool(size_t most, std::chrono::milliseconds idle_time) : most_(most), idle_time_(idle_time) {
  const std::lock_guard lock(mutex_);
  begin_thread();
}

void ThreadPool::begin_thread() {
  const bool stays = threads_.empty();
  threads_.emplace_back();
  try {
    const auto self = std::prev(threads_.end());
    self->thread = std::thread([this, self, stays] { run(self, stays); });  // waits for the mutex first
  } catch (...) {
    threads_.pop_back();
    throw;
  }
  ++free_;
}

void ThreadPool::enqueue(std::function<void()> work) {
  Threads ended;
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
    ended.swap(ended_);
    if (work_.size() > free_ && threads_.size() < most_) {
      try {
        begin_thread();
      } catch (const std::system_error&) {  // work waits for an existing thread
      } catch (const std::bad_alloc&) {
      }
    }
    count_waiting();
  }
  changed_.notify_one();
  for (Thread& one : ended) one.thread.join();
}

void ThreadPool::run(Threads::iterator self, bool stays) {
  std::unique_lock lock(mutex_);
  const auto has_something = [this] { return !work_.empty() || closed_; };
  for (;;) {
    if (stays)
      changed_.wait(lock, has_something);
    else
      changed_.wait_for(lock, idle_time_, has_something);
    if (work_.empty() && (closed_ || !stays)) break;
    --free_;
    {
      const std::function<void()> work = std::move(work_.front());
      work_.pop_front();
      count_waiting();
      lock.unlock();
      work();
    }
    lock.lock();
    ++free_;
    count_waiting();
  }
  --free_;
  count_waiting();
  ended_.splice(ended_.end(), threads_, self);
  if (threads_.empty()) changed_.notify_all();
}

void ThreadPool::shutdown() {
  std::unique_lock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return threads_.empty(); });
  Threads ended;
  ended.swap(ended_);
  lock.unlock();
  for (Thread& one : ended) one.thread.join();
}

}  // namespace papilio::server
