#include "tests/support/rate_curve.h"

#include <algorithm>
#include <cmath>

namespace papilio::test {
namespace {

/// Replacement for a distance of 0, which has no logarithm.
constexpr double least_distance = 1e-12;

double logarithm(double value) { return std::log(std::max(value, least_distance)); }

/// Returns the position of an RMS distance between `a` and `b`, 0..1, in logarithms.
double share_at(const RatePoint& a, const RatePoint& b, double rms) {
  return (logarithm(rms) - logarithm(a.rms)) / (logarithm(b.rms) - logarithm(a.rms));
}

double between(double a, double b, double share) { return std::exp((1 - share) * logarithm(a) + share * logarithm(b)); }

/// Largest ratio of the RMS distances of two points joined by a line.
constexpr double line_ratio = 1.6;

/// Returns whether `a` and `b` may be joined and `middle` is not below their line.
bool is_above(const RatePoint& middle, const RatePoint& a, const RatePoint& b) {
  return a.rms < line_ratio * b.rms && middle.bytes >= between(a.bytes, b.bytes, share_at(a, b, middle.rms));
}

}  // namespace

std::vector<RatePoint> lower_envelope(std::vector<RatePoint> points) {
  std::ranges::sort(points, [](const RatePoint& a, const RatePoint& b) {
    return a.bytes != b.bytes ? a.bytes < b.bytes : a.rms < b.rms;
  });
  std::vector<RatePoint> envelope;
  for (const RatePoint& point : points) {
    if (!envelope.empty() && point.rms >= envelope.back().rms) continue;
    while (envelope.size() > 1 && is_above(envelope.back(), envelope[envelope.size() - 2], point)) envelope.pop_back();
    envelope.push_back(point);
  }
  return envelope;
}

std::optional<RatePoint> at_rms(const std::vector<RatePoint>& envelope, double rms) {
  const auto near = std::ranges::find_if(envelope, [&](const RatePoint& point) { return point.rms <= rms; });
  if (near == envelope.end()) return std::nullopt;
  if (near == envelope.begin()) return *near;
  const RatePoint& far = *(near - 1);
  const double share = share_at(far, *near, rms);
  RatePoint found = *near;
  found.bytes = between(far.bytes, near->bytes, share);
  found.rms = rms;
  found.largest = between(far.largest, near->largest, share);
  return found;
}

}  // namespace papilio::test
