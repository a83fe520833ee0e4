#include "client/mesh_file/ear_clipper.h"

#include <algorithm>

namespace papilio::client {
namespace {

constexpr double rounding = 1e-12;      // bound of the rounding error of a product of two coordinates
constexpr double thin_height = 1e-3;    // height of a thin triangle, a share of its longest side
constexpr double equal_lengths = 1e-6;  // relative difference of squared lengths that count as equal

double squared_distance(Point2 a, Point2 b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }

/// Returns twice the signed area of a triangle, positive if it is counter-clockwise.
double area(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool are_opposite(double a, double b) { return (a > rounding && b < -rounding) || (a < -rounding && b > rounding); }

/// Returns whether two segments cross at a point inside both.
bool cross_inside(Point2 a, Point2 b, Point2 c, Point2 d) {
  return are_opposite(area(a, b, c), area(a, b, d)) && are_opposite(area(c, d, a), area(c, d, b));
}

bool coincide(Point2 a, Point2 b) { return squared_distance(a, b) <= rounding * rounding; }

}  // namespace

EarClipper::EarClipper(std::vector<Point2> corners)
    : points_(std::move(corners)),
      before_(points_.size()),
      after_(points_.size()),
      rank_(points_.size(), Rank::blocked),
      diagonal_(points_.size()) {
  const auto count = static_cast<uint32_t>(points_.size());
  for (uint32_t i = 0; i < count; ++i) {
    before_[i] = i == 0 ? count - 1 : i - 1;
    after_[i] = i + 1 == count ? 0 : i + 1;
  }
}

bool EarClipper::crosses_itself() const {
  const auto count = static_cast<uint32_t>(points_.size());
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t j = i + 2; j < count; ++j)
      if (cross_inside(points_[i], points_[after_[i]], points_[j], points_[after_[j]])) return true;
  return false;
}

bool EarClipper::is_blocked(uint32_t corner) const {
  const Point2 a = points_[before_[corner]], b = points_[corner], c = points_[after_[corner]];
  for (uint32_t other = after_[after_[corner]]; other != before_[corner]; other = after_[other]) {
    const Point2 p = points_[other];
    if (area(a, b, p) < -rounding || area(b, c, p) < -rounding || area(c, a, p) < -rounding) continue;
    if (!coincide(p, a) && !coincide(p, b) && !coincide(p, c)) return true;
  }
  return false;
}

void EarClipper::rank(uint32_t corner) {
  const Point2 a = points_[before_[corner]], b = points_[corner], c = points_[after_[corner]];
  const double twice_area = area(a, b, c);
  diagonal_[corner] = squared_distance(a, c);
  rank_[corner] = Rank::blocked;
  if (twice_area < -rounding || is_blocked(corner)) return;
  const double longest = std::max({diagonal_[corner], squared_distance(a, b), squared_distance(b, c)});
  rank_[corner] = twice_area > thin_height * longest ? Rank::sound : Rank::thin;
}

uint32_t EarClipper::best_ear() const {
  uint32_t best = first_;
  for (uint32_t i = after_[first_]; i != first_; i = after_[i])
    if (rank_[i] < rank_[best] || (rank_[i] == rank_[best] && diagonal_[i] < (1 - equal_lengths) * diagonal_[best]))
      best = i;
  return best;
}

void EarClipper::clip(uint32_t ear) {
  const uint32_t a = before_[ear], c = after_[ear];
  after_[a] = c;
  before_[c] = a;
  first_ = std::min(a, c);
  rank(a);
  rank(c);
}

std::vector<std::array<uint32_t, 3>> EarClipper::run() {
  if (points_.size() < 3 || crosses_itself()) return {};
  for (uint32_t i = 0; i < points_.size(); ++i) rank(i);
  std::vector<std::array<uint32_t, 3>> triangles;
  for (size_t left = points_.size(); left > 3; --left) {
    const uint32_t ear = best_ear();
    if (rank_[ear] == Rank::blocked) return {};
    triangles.push_back({before_[ear], ear, after_[ear]});
    clip(ear);
  }
  triangles.push_back({before_[first_], first_, after_[first_]});
  return triangles;
}

}  // namespace papilio::client
