#include "detail/unfolding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "papilio/mesh.h"

namespace papilio {
namespace {

/// Lower bound of twice a face's area in the fan, over the sum of its sides' squares.
constexpr double least_unfolded_thickness = 0.01;

struct Point {
  double x, y;
};
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
double squared(Point a) { return a.x * a.x + a.y * a.y; }

std::array<double, 3> numbers_of(Vec3d a) { return {a.x, a.y, a.z}; }

/// Returns the place in a face whose corner at `half_edge` has weight a, the next one b, and the last one c.
SurfacePlace place_in(uint32_t half_edge, double a, double b, double c) {
  std::array<double, 3> weight{};
  const uint32_t first = half_edge % 3;
  const double sum = a + b + c;
  weight[first] = a / sum;
  weight[(first + 1) % 3] = b / sum;
  weight[(first + 2) % 3] = c / sum;
  return {half_edge / 3, {weight[0], weight[1], weight[2]}};
}

}  // namespace

void Unfolding::clear() { faces_.clear(); }

void Unfolding::add(uint32_t half_edge, double length, double angle) {
  faces_.push_back({half_edge, length, angle, 0, 0});
}

void Unfolding::lay_out(size_t curve_tip) {
  double longest = 0;
  std::array<double, 2> turn{};  // angles before and after the second tip of the curve
  for (size_t i = 0; i < faces_.size(); ++i) {
    longest = std::max(longest, faces_[i].length);
    turn[i < curve_tip ? 0 : 1] += faces_[i].angle;
  }
  const double whole = curve_tip == 0 ? 2 * std::numbers::pi : std::numbers::pi;
  double angle = 0;
  for (size_t i = 0; i < faces_.size(); ++i) {
    Face& face = faces_[i];
    if (i == curve_tip && i > 0) angle = std::numbers::pi;
    face.x = face.length / longest * std::cos(angle);
    face.y = face.length / longest * (i == curve_tip ? 0 : std::sin(angle));
    angle += face.angle * whole / turn[i < curve_tip ? 0 : 1];
  }
}

bool Unfolding::is_valid() const {
  const auto at = [&](size_t i) { return Point{faces_[i % faces_.size()].x, faces_[i % faces_.size()].y}; };
  for (size_t i = 0; i < faces_.size(); ++i) {
    const Point b = at(i);
    const Point c = at(i + 1);
    if (faces_[i].half_edge != none && !(cross(b, c) > 0)) return false;
    if (i == 0 || i + 1 == faces_.size()) continue;
    const Point side = b - at(0);
    const Point other = c - at(0);
    if (!(cross(side, other) > least_unfolded_thickness * (squared(side) + squared(other)))) return false;
  }
  return true;
}

void UnfoldingSequence::push(const Unfolding& unfolding) {
  for (const Unfolding::Face& face : unfolding.faces_)
    spokes_.push_back({face.half_edge, static_cast<float>(face.x), static_cast<float>(face.y)});
  first_.push_back(spokes_.size());
}

void UnfoldingSequence::lift(std::vector<SurfacePlace>& places, size_t count, uint32_t faces,
                             const Poller& poller) const {
  std::vector<uint32_t> first_on(faces, none);  // [F] first place on each face
  std::vector<uint32_t> next(places.size());    // next place on a place's face
  const auto put = [&](uint32_t place) { next[place] = std::exchange(first_on[places[place].face], place); };
  for (uint32_t i = 0; i < places.size(); ++i) put(i);

  std::vector<uint32_t> moved;
  for (size_t u = count; u-- > 0;) {
    poller.step();
    const std::span<const Spoke> spokes(spokes_.data() + first_[u], spokes_.data() + first_[u + 1]);
    moved.clear();
    for (size_t i = 1; i + 1 < spokes.size(); ++i) {  // remaining faces, which have the first neighbour as a corner
      const uint32_t f = spokes[i].half_edge / 3;
      const uint32_t corner = spokes[i].half_edge % 3;
      for (uint32_t place = first_on[f]; place != none; place = next[place]) {
        const std::array<double, 3> w = numbers_of(places[place].weights);
        const double a = w[corner], b = w[(corner + 1) % 3], c = w[(corner + 2) % 3];
        places[place].weights = {a * spokes[0].x + b * spokes[i].x + c * spokes[i + 1].x,
                                 a * spokes[0].y + b * spokes[i].y + c * spokes[i + 1].y, 0};  // in the plane
        moved.push_back(place);
      }
      first_on[f] = none;
    }
    for (const uint32_t place : moved) {
      const Point p{places[place].weights.x, places[place].weights.y};
      double best = -std::numeric_limits<double>::infinity();
      for (size_t i = 0; i < spokes.size() && best < 0; ++i) {
        const Spoke& from = spokes[i];
        if (from.half_edge == none) continue;
        const Spoke& to = spokes[(i + 1) % spokes.size()];
        const Point b{from.x, from.y};
        const Point c{to.x, to.y};
        const double wb = cross(p, c) / cross(b, c);
        const double wc = cross(b, p) / cross(b, c);
        const double least = std::min({wb, wc, 1 - wb - wc});
        if (!(least > best)) continue;
        best = least;
        places[place] = place_in(from.half_edge, std::max(0.0, 1 - wb - wc), std::max(0.0, wb), std::max(0.0, wc));
      }
      put(place);
    }
  }
}

}  // namespace papilio
