#include "client/mesh_file/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/mesh_file/ear_clipper.h"

namespace papilio::client {
namespace {

using LocalTriangle = std::array<uint32_t, 3>;  ///< numbers of a polygon's corners
using Places = std::vector<Vec3d>;

constexpr double least_area = 1e-9;      // lower bound of a triangle's share of a polygon's area
constexpr double least_polygon = 1e-12;  // lower bound of the area vector of a polygon of extent 1
constexpr double plane_quad = 1e-3;      // upper bound of a corner's distance from a plane quad, a share of the extent
constexpr double plane_polygon = 1e-2;   // upper bound of that distance for polygons of five corners or more
constexpr double clearly_flatter = 0.3;  // lower bound of the difference of the folds' cosines
constexpr double clearly_thinner = 0.1;  // lower bound of the difference of the smallest angles' cosines
constexpr double least_angle_cosine = 0.99;  // cosine of 8 degrees

/// Returns the corners' positions from the first, scaled to magnitude 1; nothing if any is not finite or all are equal.
Places scaled_places(std::span<const uint32_t> corners, const CornerPosition& position) {
  Places places;
  double extent = 0;
  for (const uint32_t corner : corners) {
    places.push_back(to_double(position(corner)) - (places.empty() ? Vec3d{} : to_double(position(corners[0]))));
    if (places.size() == 1) places[0] -= places[0];
    const Vec3d& p = places.back();
    extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!std::isfinite(p.x + p.y + p.z)) return {};
  }
  if (extent == 0) return {};
  for (Vec3d& p : places) p = {p.x / extent, p.y / extent, p.z / extent};
  return places;
}

Vec3d normal_of(const Places& places, const LocalTriangle& t) {
  return cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
}

/// Returns the cosine of an angle; 1, the thinnest, for a side without length.
double cosine(Vec3d a, Vec3d b) {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? dot(a, b) / lengths : 1;
}

/// Returns the cosine of a triangle's smallest angle.
double smallest_angle_cosine(const Places& places, const LocalTriangle& t) {
  double most = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3d at = places[t[i]];
    most = std::max(most, cosine(places[t[(i + 1) % 3]] - at, places[t[(i + 2) % 3]] - at));
  }
  return most;
}

/// Division of a quad into two triangles.
struct Cut {
  std::array<LocalTriangle, 2> triangles;

  /// Returns whether both triangles lie on the quad's side of its area vector.
  [[nodiscard]] bool is_inside(const Places& places, Vec3d area) const {
    return std::ranges::all_of(triangles, [&](const LocalTriangle& t) {
      return dot(normal_of(places, t), area) > least_area * dot(area, area);
    });
  }
  [[nodiscard]] double fold_cosine(const Places& places) const {
    return cosine(normal_of(places, triangles[0]), normal_of(places, triangles[1]));
  }
  [[nodiscard]] double angle_cosine(const Places& places) const {
    return std::max(smallest_angle_cosine(places, triangles[0]), smallest_angle_cosine(places, triangles[1]));
  }
};

constexpr Cut first_cut{{{{0, 1, 2}, {0, 2, 3}}}};
constexpr Cut second_cut{{{{0, 1, 3}, {1, 2, 3}}}};

/// Returns the largest distance of a place from the plane through the mean of all.
double distance_from_plane(const Places& places, Vec3d area) {
  Vec3d centre;
  for (const Vec3d& p : places) centre += (1 / static_cast<double>(places.size())) * p;
  double most = 0;
  for (const Vec3d& p : places) most = std::max(most, std::abs(dot(p - centre, area)));
  return most / length(area);
}

/// Returns twice the area vector of a polygon (Newell's method).
Vec3d area_vector(const Places& places) {
  Vec3d area;
  for (size_t i = 0; i < places.size(); ++i) area += cross(places[i], places[(i + 1) % places.size()]);
  return area;
}

const Cut& better_cut(const Places& places) {
  const Vec3d area = area_vector(places);
  if (length(area) < least_polygon) return first_cut;
  if (distance_from_plane(places, area) <= plane_quad) {
    const bool is_first_inside = first_cut.is_inside(places, area);
    const bool is_second_inside = second_cut.is_inside(places, area);
    if (!is_second_inside) return first_cut;
    if (!is_first_inside) return second_cut;
  }
  const double flatter = second_cut.fold_cosine(places) - first_cut.fold_cosine(places);
  const Cut& flat = flatter > 0 ? second_cut : first_cut;
  if (std::abs(flatter) > clearly_flatter && flat.angle_cosine(places) < least_angle_cosine) return flat;
  const double thinner = first_cut.angle_cosine(places) - second_cut.angle_cosine(places);
  return thinner > clearly_thinner ? second_cut : first_cut;
}

/// Returns the triangles of a polygon of five corners or more; nothing if it is bent, crosses itself or has no area.
std::vector<LocalTriangle> clip_ears(const Places& places) {
  const Vec3d area = area_vector(places);
  if (length(area) < least_polygon || distance_from_plane(places, area) > plane_polygon) return {};
  const Vec3d normal = (1 / length(area)) * area;
  const double least = std::min({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  const Vec3d axis = std::abs(normal.x) == least   ? Vec3d{1, 0, 0}
                     : std::abs(normal.y) == least ? Vec3d{0, 1, 0}
                                                   : Vec3d{0, 0, 1};
  const Vec3d across = cross(normal, axis);
  const Vec3d right = (1 / length(across)) * across;
  const Vec3d up = cross(normal, right);
  std::vector<Point2> points;
  for (const Vec3d& p : places) points.push_back({dot(p, right), dot(p, up)});
  return EarClipper(std::move(points)).run();
}

std::vector<LocalTriangle> fan(size_t corners) {
  std::vector<LocalTriangle> triangles;
  for (uint32_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

std::vector<LocalTriangle> cut(std::span<const uint32_t> corners, const CornerPosition& position) {
  if (corners.size() > most_clipped_corners) return fan(corners.size());
  const Places places = scaled_places(corners, position);
  if (places.empty()) return fan(corners.size());
  if (corners.size() == 4) {
    const Cut& best = better_cut(places);
    return {best.triangles.begin(), best.triangles.end()};
  }
  const std::vector<LocalTriangle> ears = clip_ears(places);
  return ears.empty() ? fan(corners.size()) : ears;
}

}  // namespace

void append_polygon(std::span<const uint32_t> corners, const CornerPosition& position, Buffer<Triangle>& triangles) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  for (const auto& [a, b, c] : cut(corners, position)) triangles.push_back({corners[a], corners[b], corners[c]});
}

void PolygonList::add(std::span<const uint32_t> corners) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(corners_.size());
}

Buffer<Triangle> PolygonList::triangles(const CornerPosition& position, std::vector<uint32_t>* polygon_of) const {
  Buffer<Triangle> triangles;
  triangles.reserve(corners_.size() - std::min(corners_.size(), 2 * ends_.size()));
  size_t begin = 0;
  uint32_t number = 0;
  for (const size_t end : ends_) {
    append_polygon(std::span(corners_).subspan(begin, end - begin), position, triangles);
    begin = end;
    if (polygon_of != nullptr) polygon_of->resize(triangles.size(), number);
    ++number;
  }
  return triangles;
}

}  // namespace papilio::client
