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

/// Two connected sockets: the parked one and the client's.
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

/// Outcome of a parked socket.
struct ParkingOutcome {
  std::atomic<int> resumed = 0;
  std::atomic<bool> destroyed = false;

  std::function<void()> watch() {
    std::shared_ptr<ParkingOutcome> owner(this, [](ParkingOutcome* outcome) { outcome->destroyed = true; });
    return [this, owner] { ++resumed; };
  }
  void await_end() const {
    while (!destroyed) std::this_thread::yield();
  }
};

TEST(Parking, BytesOrADisconnectResumeASocketOnce) {
  const Pair speaker, leaver, silent;
  ParkingOutcome spoken, left, kept;
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

TEST(Parking, DeadlineResumesASocket) {
  const Pair later, sooner;
  ParkingOutcome first, second;
  Parking parking(8);
  parking.park(later.parked(), POLLIN, Clock::now() + 1h, first.watch());
  parking.park(sooner.parked(), POLLIN, Clock::now() + 10ms, second.watch());
  second.await_end();
  EXPECT_EQ(second.resumed, 1);
  EXPECT_FALSE(first.destroyed);
}

TEST(Parking, FullParkingDropsTheNextDeadline) {
  const std::array<Pair, 3> pairs;
  std::array<ParkingOutcome, 3> outcomes;
  Parking parking(2);
  const auto now = Clock::now();
  parking.park(pairs[0].parked(), POLLIN, now + 2h, outcomes[0].watch());
  parking.park(pairs[1].parked(), POLLIN, now + 1h, outcomes[1].watch());
  parking.park(pairs[2].parked(), POLLIN, now + 3h, outcomes[2].watch());
  EXPECT_TRUE(outcomes[1].destroyed);
  EXPECT_EQ(outcomes[1].resumed, 0);
  EXPECT_FALSE(outcomes[0].destroyed);
  EXPECT_FALSE(outcomes[2].destroyed);
}

TEST(Parking, ClosedParkingDropsSockets) {
  const Pair pair;
  ParkingOutcome outcome;
  Parking parking(2);
  parking.close();
  parking.park(pair.parked(), POLLIN, Clock::now() + 1h, outcome.watch());
  EXPECT_TRUE(outcome.destroyed);
  EXPECT_EQ(outcome.resumed, 0);
}

// Closing while the thread handles another event must not be missed.
TEST(Parking, CloseIsSafeAtAnyTime) {
  const std::array<Pair, 4> pairs;
  for (int i = 0; i < 5000; ++i) {
    Parking parking(pairs.size());
    auto deadline = Clock::now() + 2h;
    for (const Pair& pair : pairs) parking.park(pair.parked(), POLLIN, deadline -= 1s, [] {});  // each wakes the thread
    for (int wait = 0; wait < i % 20; ++wait) std::this_thread::yield();
    parking.close();
  }
}

TEST(Parking, SocketCanBeParkedRepeatedly) {
  Parking parking(2);
  const Pair pair;
  pair.say();  // never read
  for (int i = 0; i < 200; ++i) {
    ParkingOutcome outcome;
    parking.park(pair.parked(), POLLIN, Clock::now() + 1h, outcome.watch());
    outcome.await_end();
    ASSERT_EQ(outcome.resumed, 1);
  }
}

}  // namespace
}  // namespace papilio::server
