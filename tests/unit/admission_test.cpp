#include "server/admission.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "proto/problem.h"

namespace papilio::server {
namespace {

bool stays() { return false; }

proto::Code refusal_of(Admission& admission, const std::function<bool()>& gone) {
  try {
    (void)admission.enter(gone);
  } catch (const proto::Problem& problem) {
    return problem.code();
  }
  return proto::Code::internal;
}

TEST(Admission, RefusesWhenSlotsAndQueueAreFull) {
  Admission admission(2, 0);
  auto first = admission.enter(stays);
  const auto second = admission.enter(stays);
  EXPECT_TRUE(admission.full());
  EXPECT_THROW(admission.refuse_when_full(), proto::Problem);
  EXPECT_EQ(refusal_of(admission, stays), proto::Code::busy);
  first.reset();
  EXPECT_FALSE(admission.full());
  const auto third = admission.enter(stays);
  EXPECT_EQ(admission.computing(), 2);
}

TEST(Admission, WaitingRequestsComeInTheirOrder) {
  Admission admission(1, 8);
  auto held = admission.enter(stays);
  std::vector<int> order;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 5; ++i) {
    threads.emplace_back([&, i] {
      const auto slot = admission.enter(stays);
      order.push_back(i);  // one slot: one thread at a time
    });
    while (admission.waiting() <= i) std::this_thread::yield();
  }
  held.reset();
  threads.clear();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(admission.computing(), 0);
}

TEST(Admission, AClientThatLeavesGivesUpItsPlace) {
  Admission admission(1, 1);
  const auto held = admission.enter(stays);
  EXPECT_EQ(refusal_of(admission, [] { return true; }), proto::Code::cancelled);
  EXPECT_EQ(admission.waiting(), 0);
  Admission idle(1, 0);
  EXPECT_EQ(refusal_of(idle, [] { return true; }), proto::Code::cancelled);  // asked even when a slot is free
  EXPECT_EQ(idle.computing(), 0);
}

TEST(Admission, ManyThreadsNeverExceedTheSlots) {
  Admission admission(3, 100);
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 30; ++i) {
      threads.emplace_back([&] {
        for (int n = 0; n < 20; ++n) {
          const auto slot = admission.enter(stays);
          const int now = ++inside;
          for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
          }
          --inside;
        }
      });
    }
  }
  EXPECT_LE(most, 3);
  EXPECT_EQ(admission.computing(), 0);
}

}  // namespace
}  // namespace papilio::server
