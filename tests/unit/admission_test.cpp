#include "server/admission.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "proto/problem.h"

// Requests hold their slots until the test releases them: results do not depend on timing.

namespace papilio::server {
namespace {

using namespace std::chrono_literals;

constexpr Work small{1000, 1000};
constexpr Work large{100 * small_work, 100 * small_work};
constexpr Work unknown{1000, 100 * small_work};  ///< expected to be small, but it may be large

bool stays() { return false; }

std::optional<proto::Code> refusal_of(Admission& admission, Work work = small, const std::string& client = "a",
                                      const std::function<bool()>& gone = stays) {
  try {
    (void)admission.enter(client, work, gone);
  } catch (const proto::Problem& problem) {
    return problem.code();
  }
  return std::nullopt;
}

/// Requests that wait on their own threads and record the order of admission.
class Crowd {
 public:
  explicit Crowd(Admission& admission) : admission_(admission) {}

  /// Returns once the request waits or is answered.
  void add(const std::string& name, Work work, const std::string& client = "a") {
    const int waiting = admission_.waiting();
    const size_t answered = answers().size();
    threads_.emplace_back([this, name, work, client] {
      try {
        const auto slot = admission_.enter(client, work, stays);
        note(name);
      } catch (const proto::Problem&) {
        note(name + " refused");
      }
    });
    while (admission_.waiting() == waiting && answers().size() == answered) std::this_thread::yield();
  }
  /// Returns the order of admission once all requests are admitted.
  std::vector<std::string> finish() {
    threads_.clear();
    return answers();
  }
  std::vector<std::string> answers() {
    const std::lock_guard lock(mutex_);
    return answers_;
  }

 private:
  void note(const std::string& answer) {
    const std::lock_guard lock(mutex_);
    answers_.push_back(answer);
  }

  Admission& admission_;
  std::mutex mutex_;
  std::vector<std::string> answers_;
  std::vector<std::jthread> threads_;
};

using Names = std::vector<std::string>;
using Slots = std::vector<std::shared_ptr<Admission::Slot>>;

/// Takes all slots including the express slot, for clients outside of the test.
Slots take_all(Admission& admission, int slots) {
  Slots held;
  for (int i = 0; i < slots; ++i) held.push_back(admission.enter("held " + std::to_string(i), large, stays));
  held.push_back(admission.enter("held", small, stays));
  return held;
}

TEST(Admission, FullSlotsAndQueueRefuseRequests) {
  Admission admission(2, 0);
  Slots held = take_all(admission, 2);
  EXPECT_EQ(admission.computing(), 3);
  EXPECT_TRUE(admission.full());
  EXPECT_THROW(admission.refuse_when_full("a"), proto::Problem);
  EXPECT_EQ(refusal_of(admission), proto::Code::busy);
  held.pop_back();
  EXPECT_FALSE(admission.full());
  EXPECT_EQ(refusal_of(admission), std::nullopt);
  EXPECT_EQ(refusal_of(admission, large), proto::Code::busy) << "the express slot is for small work";
}

TEST(Admission, SmallWorkDoesNotWaitForLargeWork) {
  Admission admission(2, 4);
  Slots held{admission.enter("a", large, stays), admission.enter("a", large, stays)};
  Crowd crowd(admission);
  crowd.add("large", large);
  EXPECT_EQ(admission.waiting(), 1);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(refusal_of(admission), std::nullopt);
  EXPECT_TRUE(crowd.answers().empty());
  held.clear();
  EXPECT_EQ(crowd.finish(), Names{"large"});
}

TEST(Admission, EqualRequestsOfAClientKeepTheirOrder) {
  Admission admission(1, 8);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  for (const char* name : {"0", "1", "2", "3", "4"}) crowd.add(name, small);
  held.front().reset();
  EXPECT_EQ(crowd.finish(), (Names{"0", "1", "2", "3", "4"}));
}

TEST(Admission, LessWorkHasPriority) {
  Admission admission(1, 8);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  crowd.add("300", {300, 300});
  crowd.add("100", {100, 100});
  crowd.add("200", {200, 200});
  held.front().reset();
  EXPECT_EQ(crowd.finish(), (Names{"100", "200", "300"}));
}

TEST(Admission, LargeWorkIsOvertakenOnlyByAsMuchWork) {
  Admission admission(1, 8);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  crowd.add("large", {10'000, 10'000});
  int passed = 0;
  while (crowd.answers().empty() && passed < 100) {
    std::shared_ptr<Admission::Slot> next;
    std::jthread later([&] { next = admission.enter("a", small, stays); });
    while (admission.waiting() < 2) std::this_thread::yield();
    held.front().reset();
    later.join();
    held.front() = next;
    if (crowd.answers().empty()) ++passed;
  }
  EXPECT_GE(passed, 5);
  EXPECT_LE(passed, 10) << "ten small requests are as much work";
}

TEST(Admission, ClientWithLessWorkHasPriority) {
  Admission admission(1, 16);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  for (const char* name : {"a1", "a2", "a3", "a4"}) crowd.add(name, small, "a");
  crowd.add("b1", small, "b");
  crowd.add("b2", small, "b");
  held.front().reset();
  EXPECT_EQ(crowd.finish(), (Names{"a1", "b1", "a2", "b2", "a3", "a4"}));
}

TEST(Admission, LargeRequestsTakeAtMostHalfOfThePlaces) {
  Admission admission(1, 4);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  for (const char* name : {"large 1", "large 2", "large 3"}) crowd.add(name, large);
  EXPECT_EQ(crowd.answers(), Names{"large 3 refused"});
  crowd.add("small 1", small);
  crowd.add("small 2", small);
  EXPECT_EQ(admission.waiting(), 4);
  EXPECT_TRUE(admission.full());
  crowd.add("small 3", small);
  EXPECT_EQ(crowd.answers().back(), "small 3 refused");
  held.clear();
  (void)crowd.finish();
}

TEST(Admission, ClientWithTheMostWaitingRequestsIsRefused) {
  Admission admission(1, 4);
  Slots held = take_all(admission, 1);
  Crowd crowd(admission);
  for (const char* name : {"a1", "a2", "a3", "a4"}) crowd.add(name, small, "a");
  EXPECT_TRUE(admission.full());
  EXPECT_THROW(admission.refuse_when_full("a"), proto::Problem);
  EXPECT_NO_THROW(admission.refuse_when_full("b"));
  crowd.add("b1", small, "b");
  while (crowd.answers().empty()) std::this_thread::yield();
  EXPECT_EQ(crowd.answers(), Names{"a4 refused"});
  crowd.add("b2", small, "b");
  while (crowd.answers().size() < 2) std::this_thread::yield();
  EXPECT_EQ(crowd.answers()[1], "a3 refused");
  EXPECT_THROW(admission.refuse_when_full("b"), proto::Problem) << "both clients have two requests";
  EXPECT_EQ(refusal_of(admission, small, "b"), proto::Code::busy);
  held.clear();
  EXPECT_EQ(crowd.finish().size(), 6U);
}

TEST(Admission, UnexpectedlyLargeWorkReturnsTheExpressSlot) {
  Admission admission(1, 4, 0ms);
  auto ordinary = admission.enter("a", large, stays);
  std::atomic<bool> resumed = false;
  std::jthread thread([&] {
    const auto slot = admission.enter("b", unknown, stays);
    slot->take_turn(stays);
    resumed = true;
    slot->take_turn(stays);  // holds an ordinary slot: continues
  });
  while (admission.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(admission.computing(), 1);
  EXPECT_FALSE(resumed);
  EXPECT_EQ(refusal_of(admission), std::nullopt) << "the express slot is free";
  ordinary.reset();
  thread.join();
  EXPECT_TRUE(resumed);
  EXPECT_EQ(admission.computing(), 0);
}

TEST(Admission, CertainlySmallWorkKeepsTheExpressSlot) {
  Admission admission(1, 4, 0ms);
  const auto ordinary = admission.enter("a", large, stays);
  const auto express = admission.enter("a", small, stays);
  express->take_turn(stays);
  EXPECT_EQ(admission.computing(), 2);
}

TEST(Admission, UnexpectedlyLargeWorkIsRefusedWithoutAPlace) {
  Admission admission(1, 0, 0ms);
  const auto ordinary = admission.enter("a", large, stays);
  const auto express = admission.enter("b", unknown, stays);
  EXPECT_THROW(express->take_turn(stays), proto::Problem);
}

TEST(Admission, PausedWorkTakesAPlaceOfLargeWork) {
  Admission admission(1, 2, 0ms);
  auto ordinary = admission.enter("a", large, stays);
  std::jthread paused([&] { admission.enter("b", unknown, stays)->take_turn(stays); });
  while (admission.waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(refusal_of(admission, large), proto::Code::busy);
  EXPECT_EQ(admission.waiting(), 1) << "a paused request is not refused for a new one";
  ordinary.reset();
}

TEST(Admission, PausedRequestOfALeavingClientFreesItsPlace) {
  Admission admission(1, 2, 0ms);
  const auto ordinary = admission.enter("a", large, stays);
  {
    const auto express = admission.enter("b", unknown, stays);
    express->take_turn([] { return true; });
    EXPECT_EQ(admission.waiting(), 0);
  }
  EXPECT_EQ(admission.computing(), 1);
}

TEST(Admission, LeavingClientFreesItsPlace) {
  Admission admission(1, 1);
  const Slots held = take_all(admission, 1);
  EXPECT_EQ(refusal_of(admission, small, "a", [] { return true; }), proto::Code::cancelled);
  EXPECT_EQ(admission.waiting(), 0);
  Admission idle(1, 0);  // checked even if a slot is free
  EXPECT_EQ(refusal_of(idle, small, "a", [] { return true; }), proto::Code::cancelled);
  EXPECT_EQ(idle.computing(), 0);
}

TEST(Admission, ManyThreadsNeverExceedTheSlots) {
  Admission admission(3, 100, 0ms);
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 30; ++i) {
      threads.emplace_back([&, i] {
        for (int n = 0; n < 20; ++n) {
          const auto slot = admission.enter(std::to_string(i % 4), i % 2 ? small : unknown, stays);
          slot->take_turn(stays);
          const int now = ++inside;
          for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
          }
          --inside;
        }
      });
    }
  }
  EXPECT_LE(most, 3 + 1);
  EXPECT_EQ(admission.computing(), 0);
  EXPECT_EQ(admission.waiting(), 0);
}

}  // namespace
}  // namespace papilio::server
