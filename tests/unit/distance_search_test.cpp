#include "proto/detail/distance_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace papilio::proto::detail {
namespace {

using Value = std::function<double(double)>;

/// Searches and checks the invariants of every search.
std::vector<Probe> search(const DistanceGoal& goal, const Value& value) {
  size_t most_in_round = 0;
  const std::vector<Probe> probes = search_distance(goal, [&](std::span<const double> round) {
    most_in_round = std::max(most_in_round, round.size());
    std::vector<double> values;
    for (const double rms : round) values.push_back(value(rms));
    return values;
  });
  EXPECT_LE(probes.size(), most_probes);
  EXPECT_LE(most_in_round, 2U);
  for (size_t i = 0; i < probes.size(); ++i) {
    EXPECT_GE(probes[i].rms, goal.least);
    EXPECT_LE(probes[i].rms, goal.most);
    EXPECT_EQ(probes[i].value, value(probes[i].rms));
    for (size_t j = 0; j < i; ++j) EXPECT_NE(probes[i].rms, probes[j].rms);
  }
  return probes;
}

/// Returns the largest value found that is at most the goal, as a share of it; 0 if there is none.
double best_share(const DistanceGoal& goal, const Value& value) {
  double best = 0;
  for (const Probe& probe : search(goal, value))
    if (probe.value <= goal.value) best = std::max(best, probe.value / goal.value);
  return best;
}

TEST(DistanceSearch, IncreasingPowersReachTheGoal) {
  for (const double power : {0.6, 0.8, 1.0, 1.3, 1.7})
    for (const double factor : {2.0, 8.0, 50.0}) {
      const DistanceGoal goal{.value = 1e-3, .power = 1, .first = 1e-3 / 8};
      EXPECT_GE(best_share(goal, [&](double rms) { return factor * 1e-3 * std::pow(rms / 1e-3, power); }), 0.95)
          << power << ' ' << factor;
    }
}

TEST(DistanceSearch, DecreasingPowersReachTheGoal) {
  for (const double power : {-0.5, -0.9, -1.4})
    for (const double goal_bytes : {3e3, 4e4, 2e5}) {
      const DistanceGoal goal{.value = goal_bytes, .power = -0.8, .first = 1e-3};
      EXPECT_GE(best_share(goal, [&](double rms) { return 1e4 * std::pow(rms / 1e-3, power); }), 0.95)
          << power << ' ' << goal_bytes;
    }
}

TEST(DistanceSearch, NonMonotoneValuesReachFourFifthsOfTheGoal) {
  for (const double phase : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    const DistanceGoal goal{.value = 1e-3, .power = 1, .first = 1e-3 / 8};
    EXPECT_GE(best_share(goal, [&](double rms) { return 5 * rms * (1 + 0.15 * std::sin(20 * std::log(rms) + phase)); }),
              0.8)
        << phase;
  }
}

TEST(DistanceSearch, DiscontinuityIsApproachedFromBelow) {
  const DistanceGoal goal{.value = 1e-3, .power = 1, .first = 1e-3 / 8};
  EXPECT_GE(best_share(goal, [](double rms) { return rms < 2.3e-4 ? 3 * rms : 30 * rms; }), 0.55);
}

TEST(DistanceSearch, FirstProbeNearEnoughEndsTheSearch) {
  const DistanceGoal goal{.value = 1e-3, .power = 1, .first = 1e-4};
  EXPECT_EQ(search(goal, [](double rms) { return 9.95 * rms; }), (std::vector<Probe>{{1e-4, 9.95 * 1e-4}}));
}

TEST(DistanceSearch, UnreachableGoalsEndAtTheBounds) {
  const DistanceGoal goal{.value = 1e-3, .power = 1, .first = 1e-4};
  const std::vector<Probe> out_of_reach = search(goal, [](double rms) { return 1 + rms; });
  EXPECT_EQ(std::ranges::min(out_of_reach, {}, &Probe::rms).rms, goal.least);
  const std::vector<Probe> always = search(goal, [](double rms) { return 1e-6 * (1 + rms); });
  EXPECT_EQ(std::ranges::max(always, {}, &Probe::rms).rms, goal.most);
}

TEST(DistanceSearch, EncoderExceptionsAreRethrown) {
  EXPECT_THROW((void)search_distance({.value = 1}, [](auto) -> std::vector<double> { throw std::runtime_error("no"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace papilio::proto::detail
