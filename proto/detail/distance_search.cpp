#include "proto/detail/distance_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace papilio::proto::detail {
namespace {

constexpr double near_enough = 0.01;    // upper bound of the gap below the goal, a share of the goal
constexpr double narrow_enough = 0.01;  // upper bound of the ratio of the bracket's distances, less 1
/// Ratio of the two distances of a round to the distance at which the goal is expected.
constexpr double spread_without_bracket = 1.3, spread_in_bracket = 1.03;
/// Lower bound of the gap between a new distance and the bracket's ends, a share of the bracket in logarithms.
constexpr double bracket_margin = 0.1;

/// Axis of distances: the logarithm, with the sign that makes values grow along it.
class Axis {
 public:
  explicit Axis(const DistanceGoal& goal) : goal_(goal), sign_(goal.power > 0 ? 1 : -1) {}
  [[nodiscard]] double of(double rms) const { return sign_ * std::log(rms); }
  [[nodiscard]] double distance(double at) const {
    constexpr double rounding = 1e-12;
    if (at <= least() + rounding) return sign_ > 0 ? goal_.least : goal_.most;
    if (at >= most() - rounding) return sign_ > 0 ? goal_.most : goal_.least;
    return std::exp(sign_ * at);
  }
  [[nodiscard]] double slope() const { return std::abs(goal_.power); }
  [[nodiscard]] double least() const { return std::min(of(goal_.least), of(goal_.most)); }
  [[nodiscard]] double most() const { return std::max(of(goal_.least), of(goal_.most)); }
  /// Returns the logarithm of the value over the goal.
  [[nodiscard]] double excess(const Probe& probe) const { return std::log(probe.value / goal_.value); }

 private:
  const DistanceGoal& goal_;
  double sign_;
};

class Search {
 public:
  Search(const DistanceGoal& goal, const MeasureRound& measure) : goal_(goal), axis_(goal), measure_(measure) {}

  std::vector<Probe> run() {
    for (std::vector<double> round{std::clamp(goal_.first, goal_.least, goal_.most)}; !round.empty();
         round = next_round())
      add(round);
    return std::move(probes_);
  }

 private:
  void add(const std::vector<double>& round) {
    const std::vector<double> values = measure_(round);
    for (size_t i = 0; i < round.size(); ++i) {
      probes_.push_back({round[i], values[i]});
      const double excess = axis_.excess(probes_.back());
      is_found_ |= excess <= 0 && excess >= std::log(1 - near_enough);
    }
    // Values are not quite monotonic: the goal lies beyond the last value below it.
    below_.reset(), above_.reset();
    for (const Probe& probe : probes_)
      if (axis_.excess(probe) <= 0 && (!below_ || axis_.of(probe.rms) > axis_.of(below_->rms))) below_ = probe;
    for (const Probe& probe : probes_) {
      if (axis_.excess(probe) <= 0 || (below_ && axis_.of(probe.rms) < axis_.of(below_->rms))) continue;
      if (!above_ || axis_.of(probe.rms) < axis_.of(above_->rms)) above_ = probe;
    }
  }

  [[nodiscard]] std::vector<double> next_round() const {
    if (is_found_ || probes_.size() >= most_probes) return {};
    std::vector<double> round;
    for (const double at : below_&& above_ ? between() : beyond()) {
      const double rms = axis_.distance(at);
      const bool is_known = std::ranges::find(probes_, rms, &Probe::rms) != probes_.end();
      if (!is_known && std::ranges::find(round, rms) == round.end() && probes_.size() + round.size() < most_probes)
        round.push_back(rms);
    }
    return round;
  }

  /// Returns coordinates round the goal on the line through the bracket's ends.
  [[nodiscard]] std::vector<double> between() const {
    const double a = axis_.of(below_->rms);
    const double b = axis_.of(above_->rms);
    if (b - a < std::log(1 + narrow_enough)) return {};
    const double at_a = axis_.excess(*below_);
    const double at_b = axis_.excess(*above_);
    const double root = a - at_a * (b - a) / (at_b - at_a);
    const double half = std::min(std::log(spread_in_bracket), bracket_margin * (b - a));
    const auto inside = [&](double at) {
      return std::clamp(at, a + bracket_margin * (b - a), b - bracket_margin * (b - a));
    };
    return {inside(root - half), inside(root + half)};
  }

  /// Returns coordinates round the goal while all probes lie on one side of it; the outer one moves farther each time.
  [[nodiscard]] std::vector<double> beyond() const {
    const Probe& nearest = below_ ? *below_ : *above_;
    const double away = -axis_.excess(nearest) / slope_at(nearest);
    const size_t rounds = probes_.size() / 2;
    const auto widening = static_cast<double>(size_t{1} << rounds);
    const double root = axis_.of(nearest.rms) + away;
    const double half = (away > 0 ? 1 : -1) * std::log(spread_without_bracket) * widening;
    const auto inside = [&](double at) { return std::clamp(at, axis_.least(), axis_.most()); };
    return {inside(std::abs(half) < std::abs(away) ? root - half : root), inside(root + half)};
  }

  /// Returns the slope of the line through a probe and its neighbour, clamped to half to twice the expected slope.
  [[nodiscard]] double slope_at(const Probe& probe) const {
    const double at = axis_.of(probe.rms);
    const Probe* neighbour = nullptr;
    for (const Probe& other : probes_) {
      const double distance = std::abs(axis_.of(other.rms) - at);
      if (distance > 0 && (neighbour == nullptr || distance < std::abs(axis_.of(neighbour->rms) - at)))
        neighbour = &other;
    }
    if (neighbour == nullptr) return axis_.slope();
    const double found = (axis_.excess(*neighbour) - axis_.excess(probe)) / (axis_.of(neighbour->rms) - at);
    return std::clamp(found, axis_.slope() / 2, axis_.slope() * 2);
  }

  const DistanceGoal& goal_;
  Axis axis_;
  const MeasureRound& measure_;
  std::vector<Probe> probes_;
  std::optional<Probe> below_, above_;  ///< probes nearest to the goal
  bool is_found_ = false;
};

}  // namespace

std::vector<Probe> search_distance(const DistanceGoal& goal, const MeasureRound& measure) {
  return Search(goal, measure).run();
}

}  // namespace papilio::proto::detail
