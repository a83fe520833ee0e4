#include "server/http/parking.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace papilio::server {
namespace {

using namespace std::chrono_literals;
using Clock = Parking::Clock;

/// Two connected sockets: one is parked, the other is the client's.
class Pair {
 public:
  Pair() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()), 0); }
  ~Pair() {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  [[nodiscard]] int parked() const { return ends_[0]; }
  void say() const { EXPECT_EQ(::send(ends_[1], "x", 1, 0), 1); }
  void leave() const { ::shutdown(ends_[1], SHUT_RDWR); }

 private:
  std::array<int, 2> ends_{};
};

/// What became of a parked socket.
struct Fate {
  std::atomic<int> resumed = 0;
  std::atomic<bool> destroyed = false;

  std::function<void()> watch() {
    std::shared_ptr<Fate> owner(this, [](Fate* fate) { fate->destroyed = true; });
    return [this, owner] { ++resumed; };
  }
  void await_end() const {
    while (!destroyed) std::this_thread::yield();
  }
};

TEST(Parking, ResumesOnceWhenBytesComeOrTheClientLeaves) {
  const Pair speaker, leaver, silent;
  Fate spoken, left, kept;
  Parking parking(8);
  const auto late = Clock::now() + 1h;
  parking.park(speaker.parked(), POLLIN, late, spoken.watch());
  parking.park(leaver.parked(), POLLIN, late, left.watch());
  parking.park(silent.parked(), POLLIN, late, kept.watch());
  speaker.say();
  leaver.leave();
  spoken.await_end();
  left.await_end();
  EXPECT_EQ(spoken.resumed, 1);
  EXPECT_EQ(left.resumed, 1);
  EXPECT_FALSE(kept.destroyed);
  parking.close();
  EXPECT_TRUE(kept.destroyed);
  EXPECT_EQ(kept.resumed, 0);
}

TEST(Parking, ResumesAtTheDeadline) {
  const Pair later, sooner;
  Fate first, second;
  Parking parking(8);
  parking.park(later.parked(), POLLIN, Clock::now() + 1h, first.watch());
  parking.park(sooner.parked(), POLLIN, Clock::now() + 10ms, second.watch());
  second.await_end();
  EXPECT_EQ(second.resumed, 1);
  EXPECT_FALSE(first.destroyed);
}

TEST(Parking, WhenFullTheNextDeadlineGivesWay) {
  const std::array<Pair, 3> pairs;
  std::array<Fate, 3> fates;
  Parking parking(2);
  const auto now = Clock::now();
  parking.park(pairs[0].parked(), POLLIN, now + 2h, fates[0].watch());
  parking.park(pairs[1].parked(), POLLIN, now + 1h, fates[1].watch());
  parking.park(pairs[2].parked(), POLLIN, now + 3h, fates[2].watch());
  EXPECT_TRUE(fates[1].destroyed);
  EXPECT_EQ(fates[1].resumed, 0);
  EXPECT_FALSE(fates[0].destroyed);
  EXPECT_FALSE(fates[2].destroyed);
}

TEST(Parking, ClosedItKeepsNothing) {
  const Pair pair;
  Fate fate;
  Parking parking(2);
  parking.close();
  parking.park(pair.parked(), POLLIN, Clock::now() + 1h, fate.watch());
  EXPECT_TRUE(fate.destroyed);
  EXPECT_EQ(fate.resumed, 0);
}

// Closing while the thread wakes up for something else: its call must not be lost.
TEST(Parking, IsClosedWhateverItIsDoing) {
  const std::array<Pair, 4> pairs;
  for (int i = 0; i < 5000; ++i) {
    Parking parking(pairs.size());
    auto deadline = Clock::now() + 2h;
    for (const Pair& pair : pairs) parking.park(pair.parked(), POLLIN, deadline -= 1s, [] {});  // each wakes it
    for (int wait = 0; wait < i % 20; ++wait) std::this_thread::yield();
    parking.close();
  }
}

TEST(Parking, TheSameSocketIsParkedAgainAndAgain) {
  Parking parking(2);
  const Pair pair;
  pair.say();  // and nobody reads it
  for (int i = 0; i < 200; ++i) {
    Fate fate;
    parking.park(pair.parked(), POLLIN, Clock::now() + 1h, fate.watch());
    fate.await_end();
    ASSERT_EQ(fate.resumed, 1);
  }
}

}  // namespace
}  // namespace papilio::server
