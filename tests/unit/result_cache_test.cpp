#include "server/cache/result_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <thread>
#include <vector>

#include "proto/problem.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;
using Source = ResultCache::Source;

constexpr uint64_t enough = 1 << 20;

bool never_leaves() { return false; }

ResultCache::Result result(const std::string& bytes) {
  return std::make_shared<const proto::EncodedLevel>(proto::EncodedLevel{bytes, {}});
}

TEST(ResultCache, ResultIsComputedOnceAndCached) {
  ResultCache cache(enough, 8);
  int made = 0;
  const auto make = [&](const ResultCache::Question&) {
    ++made;
    return result("bytes");
  };
  EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::made);
  const ResultCache::Answer again = cache.get_or_make("a", make, never_leaves);
  EXPECT_EQ(again.source, Source::kept);
  EXPECT_EQ(again.result->bytes, "bytes");
  EXPECT_EQ(cache.get_or_make("b", make, never_leaves).source, Source::made);
  EXPECT_EQ(made, 2);
}

TEST(ResultCache, CacheWithoutABudgetStoresNothing) {
  ResultCache cache(0, 8);
  const auto make = [&](const ResultCache::Question&) { return result("bytes"); };
  EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::made);
  EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::made);
}

TEST(ResultCache, ConcurrentRequestsShareOneComputation) {
  ResultCache cache(enough, 8);
  constexpr int others = 5;
  std::atomic<int> made = 0;
  std::atomic<int> shared = 0;
  std::latch begun(1);
  std::atomic<int> asked = 0;
  const auto make = [&](const ResultCache::Question&) {
    ++made;
    begun.count_down();
    while (asked < others) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // lets them begin to wait
    return result("bytes");
  };
  std::jthread maker([&] { EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::made); });
  begun.wait();
  std::vector<std::jthread> threads;
  for (int i = 0; i < others; ++i)
    threads.emplace_back([&] {
      ++asked;
      const ResultCache::Answer answer = cache.get_or_make("a", make, never_leaves);
      EXPECT_EQ(answer.result->bytes, "bytes");
      if (answer.source == Source::shared) ++shared;
    });
  threads.clear();
  maker.join();
  EXPECT_EQ(made, 1);
  EXPECT_GT(shared, 0);
}

TEST(ResultCache, ProblemReachesAllWaitersAndIsNotCached) {
  ResultCache cache(enough, 8);
  const auto fail = [](const ResultCache::Question&) -> ResultCache::Result {
    throw Problem(Code::result_too_large, "Ask for fewer levels, please.");
  };
  EXPECT_THROW((void)cache.get_or_make("a", fail, never_leaves), Problem);
  const auto make = [](const ResultCache::Question&) { return result("bytes"); };
  EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::made);
}

/// The client of the computing request leaves: the computation stops without waiters and continues with waiters.
TEST(ResultCache, ComputationIsAbandonedOnlyWithoutWaiters) {
  ResultCache cache(enough, 8);
  const auto give_up = [](const ResultCache::Question& abandoned) -> ResultCache::Result {
    if (abandoned()) throw Problem(Code::cancelled, "The client went away.");
    return result("bytes");
  };
  EXPECT_THROW((void)cache.get_or_make("a", give_up, [] { return true; }), Problem);

  std::latch begun(1);
  const auto wait_for_company = [&](const ResultCache::Question& abandoned) {
    begun.count_down();
    while (abandoned()) std::this_thread::yield();  // until a request waits
    return result("for the other");
  };
  std::jthread leaver([&] { (void)cache.get_or_make("b", wait_for_company, [] { return true; }); });
  begun.wait();
  const ResultCache::Answer answer = cache.get_or_make(
      "b", [](const ResultCache::Question&) { return result("made anew"); }, never_leaves);
  EXPECT_EQ(answer.result->bytes, "for the other");
}

TEST(ResultCache, WaiterOfALeavingClientIsCancelled) {
  ResultCache cache(enough, 8);
  std::latch begun(1);
  std::latch end(1);
  std::jthread maker([&] {
    (void)cache.get_or_make(
        "a",
        [&](const ResultCache::Question&) {
          begun.count_down();
          end.wait();
          return result("bytes");
        },
        never_leaves);
  });
  begun.wait();
  const auto never = [](const ResultCache::Question&) -> ResultCache::Result {
    ADD_FAILURE();
    return nullptr;
  };
  EXPECT_THROW((void)cache.get_or_make("a", never, [] { return true; }), Problem);
  end.count_down();
}

TEST(ResultCache, WaitersAreBounded) {
  ResultCache cache(enough, 1);
  std::latch begun(1);
  std::latch end(1);
  const auto make = [&](const ResultCache::Question&) {
    begun.count_down();
    end.wait();
    return result("bytes");
  };
  std::jthread maker([&] { (void)cache.get_or_make("a", make, never_leaves); });
  begun.wait();
  std::atomic<bool> asked = false;
  std::jthread waiter(
      [&] { EXPECT_EQ(cache.get_or_make("a", make, [&] { return !(asked = true); }).source, Source::shared); });
  while (!asked) std::this_thread::yield();  // its client is polled while it waits
  EXPECT_THROW((void)cache.get_or_make("a", make, never_leaves), Problem);
  end.count_down();
  waiter.join();
  EXPECT_EQ(cache.get_or_make("a", make, never_leaves).source, Source::kept);
}

TEST(ResultCache, ResultCachedMeanwhileIsNotComputedAgain) {
  ResultCache cache(uint64_t{64} << 20, 8);
  constexpr int results = 20000;
  std::atomic<int> made = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < results; ++i)
        (void)cache.get_or_make(
            std::to_string(i),
            [&](const ResultCache::Question&) {
              ++made;
              return result("bytes");
            },
            never_leaves);
    });
  threads.clear();
  EXPECT_EQ(made, results);
}

TEST(ResultCache, WaiterComputesAfterTheFirstRequestIsCancelled) {
  ResultCache cache(enough, 8);
  std::latch begun(1);
  std::atomic<bool> waits = false;
  std::jthread leaver([&] {
    EXPECT_THROW((void)cache.get_or_make(
                     "a",
                     [&](const ResultCache::Question&) -> ResultCache::Result {
                       begun.count_down();
                       while (!waits) std::this_thread::yield();
                       std::this_thread::sleep_for(std::chrono::milliseconds(20));
                       throw Problem(Code::cancelled, "The client went away.");
                     },
                     never_leaves),
                 Problem);
  });
  begun.wait();
  waits = true;
  const ResultCache::Answer answer = cache.get_or_make(
      "a", [](const ResultCache::Question&) { return result("made anew"); }, never_leaves);
  EXPECT_EQ(answer.result->bytes, "made anew");
}

}  // namespace
}  // namespace papilio::server
