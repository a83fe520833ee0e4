#include "deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lighting.h"
#include "triangle_distance.h"

namespace papilio {
namespace {

TriangleCorners corners(const Mesh& mesh, uint32_t h) {
  const auto at = [&](uint32_t v) { return to_double(mesh.positions[v]); };
  return {at(mesh.topology.origin[h]), at(mesh.topology.tip(h)), at(mesh.topology.apex(h))};
}

/// A side of triangles, and a point: from an end of the side `along` leads to its other end, `to_point` to the point.
struct Side {
  Side(Vec3d end, Vec3d other_end, Vec3d point)
      : along(other_end - end),
        to_point(point - end),
        aa(dot(along, along)),
        pa(dot(to_point, along)),
        pp(dot(to_point, to_point)) {}
  Vec3d along, to_point;
  double aa, pa, pp;
};

/// Where the point lies, seen from the triangle whose third corner `to_apex` leads to.
struct Foot {
  enum : uint8_t {
    above_face,    ///< above the triangle
    beyond_side,   ///< across that side, and no other
    anywhere_else  ///< or not known for sure
  } where = anywhere_else;
  double squared_height = 0;  ///< above the plane
};

inline Foot find_foot(const Side& side, Vec3d to_apex) {
  constexpr double least_sine_squared = 1e-8;
  const double aa = side.aa;
  const double pa = side.pa;
  const double ac = dot(side.along, to_apex);
  const double cc = dot(to_apex, to_apex);
  const double area_squared = aa * cc - ac * ac;  // of the parallelogram
  if (area_squared <= least_sine_squared * aa * cc) return {};
  const double pc = dot(side.to_point, to_apex);
  // The foot is made of the corners in these shares of the area.
  const double of_other_end = cc * pa - ac * pc;
  const double of_apex = aa * pc - ac * pa;
  const double of_end = area_squared - of_other_end - of_apex;
  if (of_other_end < 0 || of_end < 0) return {};
  if (of_apex < 0) return {Foot::beyond_side};
  const double height = dot(side.to_point, cross(side.along, to_apex));
  constexpr double rounding_squared = 1e-30;  // of the height's parts: what is flat is to have none
  if (height * height <= rounding_squared * side.pp * aa * cc) return {Foot::above_face, 0};
  return {Foot::above_face, height * height / area_squared};
}

/// The distance to two triangles at one side where it is found easily: mostly the point is above one of them, or above
/// the side itself.
std::optional<double> squared_distance_to_either(Vec3d point, Vec3d a, Vec3d b, Vec3d apex, Vec3d other_apex) {
  const Side side(a, b, point);
  const Foot one = find_foot(side, apex - a);
  const Foot other = find_foot(side, other_apex - a);
  if (one.where == Foot::anywhere_else || other.where == Foot::anywhere_else) return {};
  if (one.where == Foot::above_face && other.where == Foot::above_face)
    return std::min(one.squared_height, other.squared_height);
  // From beyond the side the nearest is on the side, which is the other triangle's, too.
  if (one.where == Foot::above_face) return one.squared_height;
  if (other.where == Foot::above_face) return other.squared_height;
  return squared_distance_to_segment(point, a, b);
}

/// Infinity is kept for what is not to be reached: a budget's threshold where nothing fits.
float to_finite(double number) {
  return static_cast<float>(std::min<double>(std::numeric_limits<float>::max(), number));
}

}  // namespace

double deviation(const Mesh& mesh, uint32_t edge, Vec3f q) {
  const Topology& topology = mesh.topology;
  uint32_t h = topology.half_edge[edge];
  const Vec3d point = to_double(q);
  // Which of its half-edges the edge names depends on how the level was made; what is rounded must not.
  if (topology.origin[h] > topology.tip(h) && topology.twin[h] != none) h = topology.twin[h];
  const TriangleCorners face = corners(mesh, h);
  if (topology.kind[edge] != EdgeKind::smooth) return std::sqrt(squared_distance_to_segment(point, face.a, face.b));
  const TriangleCorners other = corners(mesh, topology.twin[h]);
  if (const auto squared = squared_distance_to_either(point, face.a, face.b, face.c, other.c))
    return std::sqrt(*squared);
  return std::sqrt(std::min(squared_distance(point, face), squared_distance(point, other)));
}

ErrorMeasure::ErrorMeasure(double tolerance, double diagonal, const View* view, const Camera* camera)
    : diagonal_(diagonal), tolerated_(tolerance * diagonal), view_(view), camera_(camera) {
  if (view != nullptr) tolerated_pixels_ = view->error_pixels;
  if (tolerated_ > 0 && tolerated_pixels_ > 0)
    threshold_ = 1;
  else
    threshold_ = static_cast<float>(tolerated_ > 0 ? tolerance : tolerated_pixels_);
}

float ErrorMeasure::most_error(double distance, double scale) const {
  if (camera_ == nullptr || (tolerated_ > 0 && tolerated_pixels_ == 0))
    return to_finite(diagonal_ > 0 ? distance / diagonal_ : 0);
  if (!view_->lights.empty()) return std::numeric_limits<float>::infinity();
  const double seen = distance * scale;
  return to_finite(tolerated_ == 0 ? seen : std::min(distance / tolerated_, seen / tolerated_pixels_));
}

double ErrorMeasure::least_deviation(float error, double scale) const {
  constexpr double rounding = 1 - 1e-6;
  if (camera_ == nullptr || (tolerated_ > 0 && tolerated_pixels_ == 0)) return rounding * error * diagonal_;
  if (!view_->lights.empty()) return 0;
  if (tolerated_ == 0) return rounding * error / scale;
  return rounding * error * std::max(tolerated_, tolerated_pixels_ / scale);
}

float ErrorMeasure::error(const Mesh& mesh, const Array<Vec3f>& normals, uint32_t edge, double distance) const {
  if (camera_ == nullptr || (tolerated_ > 0 && tolerated_pixels_ == 0))
    return to_finite(diagonal_ > 0 ? distance / diagonal_ : 0);
  double seen = pixels(mesh, edge, distance);
  if (!view_->lights.empty()) seen *= light_weight(mesh, normals, edge, distance, *view_, *camera_);
  if (tolerated_ == 0) return to_finite(seen);
  return to_finite(std::min(distance / tolerated_, seen / tolerated_pixels_));
}

}  // namespace papilio
