#include "server/http/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace papilio::server {
namespace {

using std::chrono::milliseconds;

TEST(ThreadPool, AllWorkRunsOnAtMostTheGivenThreads) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::atomic<int> running = 0;
  std::atomic<int> most = 0;
  std::atomic<int> done = 0;
  ThreadPool pool(4, milliseconds(1000));
  for (int i = 0; i < 100; ++i)
    pool.enqueue([&] {
      const int now = ++running;
      if (now > most) most = now;
      {
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
      }
      std::this_thread::sleep_for(milliseconds(2));
      --running;
      ++done;
    });
  pool.shutdown();
  EXPECT_EQ(done, 100);
  EXPECT_LE(most, 4);
  EXPECT_LE(threads.size(), 4U);
}

TEST(ThreadPool, WaitingWorkIsReported) {
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  std::atomic<int> begun = 0;
  const auto wait = [&] {
    ++begun;
    ended.wait();
  };
  ThreadPool pool(2, milliseconds(1000));
  EXPECT_FALSE(pool.has_waiting());
  pool.enqueue(wait);
  pool.enqueue(wait);
  EXPECT_FALSE(pool.has_waiting()) << "each has a thread";
  while (begun < 2) std::this_thread::yield();
  pool.enqueue(wait);
  EXPECT_TRUE(pool.has_waiting());
  end.set_value();
  while (begun < 3) std::this_thread::yield();
  EXPECT_FALSE(pool.has_waiting());
}

TEST(ThreadPool, IdleThreadsEndAndRestartOnDemand) {
  std::atomic<int> ended = 0;
  struct Last {
    std::atomic<int>* count = nullptr;
    ~Last() {
      if (count != nullptr) ++*count;
    }
  };
  std::atomic<int> begun = 0;
  const auto work = [&] {
    thread_local Last last;
    last.count = &ended;
    ++begun;
    while (begun % 3 != 0) std::this_thread::yield();
  };
  ThreadPool pool(3, milliseconds(20));
  for (int round = 1; round <= 2; ++round) {
    for (int i = 0; i < 3; ++i) {
      pool.enqueue(work);
      while (begun % 3 != (i + 1) % 3) std::this_thread::yield();
    }
    while (ended < 2 * round) std::this_thread::yield();
  }
  EXPECT_EQ(begun, 6);
  pool.shutdown();
  EXPECT_GE(ended, 5) << "the last thread ends with the pool";
}

}  // namespace
}  // namespace papilio::server
