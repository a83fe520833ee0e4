#include "deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting.h"
#include "triangle_distance.h"

namespace papilio {
namespace {

TriangleCorners corners(const Mesh& mesh, uint32_t h) {
  const auto at = [&](uint32_t v) { return to_double(mesh.positions[v]); };
  return {at(mesh.topology.origin[h]), at(mesh.topology.tip(h)), at(mesh.topology.apex(h))};
}

/// Infinity is kept for what is not to be reached: a budget's threshold where nothing fits.
float to_finite(double number) {
  return static_cast<float>(std::min<double>(std::numeric_limits<float>::max(), number));
}

}  // namespace

double deviation(const Mesh& mesh, uint32_t edge, Vec3f q) {
  const uint32_t h = mesh.topology.half_edge[edge];
  const TriangleCorners face = corners(mesh, h);
  if (mesh.topology.kind[edge] != EdgeKind::smooth)
    return std::sqrt(squared_distance_to_segment(to_double(q), face.a, face.b));
  const TriangleCorners other = corners(mesh, mesh.topology.twin[h]);
  return std::sqrt(std::min(squared_distance(to_double(q), face), squared_distance(to_double(q), other)));
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
