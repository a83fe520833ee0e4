#include "criteria/deviation.h"

#include <cmath>
#include <limits>
#include <optional>

#include "criteria/camera.h"
#include "criteria/lighting.h"
#include "papilio/triangle_distance.h"
#include "simd/extremes.h"

namespace papilio {
namespace {

/// One number for each of two triangles, computed in parallel.
using Both = double __attribute__((vector_size(16)));
using BothTrue = int64_t __attribute__((vector_size(16)));

struct BothVectors {
  BothVectors(Vec3d one, Vec3d other) : x{one.x, other.x}, y{one.y, other.y}, z{one.z, other.z} {}
  Both x, y, z;
};

Both dot(Vec3d a, const BothVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

bool is_any(BothTrue both) { return (both[0] | both[1]) != 0; }

/// Returns the squared distance to two triangles with a common side in the frequent cases: the point is above one of
/// them, or nearest to the common side. Returns nothing in other or uncertain cases.
std::optional<double> squared_distance_to_either(Vec3d point, Vec3d a, Vec3d b, Vec3d apex, Vec3d other_apex) {
  constexpr double least_sine_squared = 1e-8;
  constexpr double rounding_squared = 1e-30;  // share of the height's terms below which the height is 0
  const Vec3d along = b - a;
  const Vec3d to_point = point - a;
  const BothVectors to_apex(apex - a, other_apex - a);
  const double aa = papilio::dot(along, along);
  const double pa = papilio::dot(to_point, along);
  const double pp = papilio::dot(to_point, to_point);
  const Both ac = dot(along, to_apex);
  const Both cc = to_apex.x * to_apex.x + to_apex.y * to_apex.y + to_apex.z * to_apex.z;
  const Both area_squared = aa * cc - ac * ac;  // squared area of the parallelogram
  const Both pc = dot(to_point, to_apex);
  // Barycentric coordinates of the point's foot on the plane, times the squared area.
  const Both of_other_end = cc * pa - ac * pc;
  const Both of_apex = aa * pc - ac * pa;
  const Both of_end = area_squared - of_other_end - of_apex;
  if (is_any((area_squared <= least_sine_squared * aa * cc) | (of_other_end < 0) | (of_end < 0))) return {};

  // The foot is inside the triangle, or beyond the common side only.
  const BothTrue is_beyond = of_apex < 0;
  // If it is beyond the side in both triangles, the nearest point is on the side.
  if (is_beyond[0] != 0 && is_beyond[1] != 0) return squared_distance_to_segment(point, a, b);
  const Both height = to_point.x * (along.y * to_apex.z - along.z * to_apex.y) +
                      to_point.y * (along.z * to_apex.x - along.x * to_apex.z) +
                      to_point.z * (along.x * to_apex.y - along.y * to_apex.x);
  const BothTrue is_flat = height * height <= rounding_squared * pp * aa * cc;
  const Both squared = is_flat ? Both{} : height * height / area_squared;
  // Branch-free: the nearer triangle is unpredictable.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Both above_either = is_beyond ? Both{infinity, infinity} : squared;
  return lesser(above_either[0], above_either[1]);
}

/// Clamps an error to finite floats: infinity is the threshold of a budget that no edge fits.
float to_finite(double number) { return static_cast<float>(lesser(double{std::numeric_limits<float>::max()}, number)); }

}  // namespace

double deviation_from_faces(Vec3f q, Vec3f a, Vec3f b, Vec3f apex, Vec3f other_apex) {
  const Vec3d point = to_double(q);
  const TriangleCorners face{to_double(a), to_double(b), to_double(apex)};
  const TriangleCorners other{face.b, face.a, to_double(other_apex)};
  const double most = squared_distance_to_middle(q, a, b);
  if (const auto squared = squared_distance_to_either(point, face.a, face.b, face.c, other.c))
    return std::sqrt(lesser(*squared, most));
  return std::sqrt(lesser(squared_distance(point, face), squared_distance(point, other), most));
}

double deviation(const Mesh& mesh, EdgeId edge, Vec3f q) {
  const Topology& topology = mesh.topology;
  const auto at = [&](VertexId v) { return mesh.positions[v]; };
  HalfEdgeId h = topology.half_edge[edge];
  const HalfEdgeId t = topology.twin[h];
  // The choice of half_edge depends on how the level was made; rounding must not. So h is the half-edge from the lower
  // vertex.
  if (topology.origin[h] > topology.tip(h) && t != none) h = t;
  const Vec3f a = at(topology.origin[h]);
  const Vec3f b = at(topology.tip(h));
  if (topology.kind[edge] != EdgeKind::smooth)
    return std::sqrt(lesser(squared_distance_to_segment(to_double(q), to_double(a), to_double(b)),
                            squared_distance_to_middle(q, a, b)));
  return deviation_from_faces(q, a, b, at(topology.apex(h)), at(topology.apex(topology.twin[h])));
}

ErrorMeasure::ErrorMeasure(double tolerance, double diagonal, const View* view, const Camera* camera)
    : diagonal_(diagonal), tolerated_(tolerance * diagonal), view_(view), camera_(camera) {
  if (view != nullptr) tolerated_pixels_ = view->error_pixels;
  if (tolerated_ > 0 && tolerated_pixels_ > 0)
    threshold_ = 1;
  else
    threshold_ = static_cast<float>(tolerated_ > 0 ? tolerance : tolerated_pixels_);
}

double ErrorMeasure::least_deviation(float error, double scale) const {
  constexpr double rounding = 1 - 1e-6;
  if (camera_ == nullptr || (tolerated_ > 0 && tolerated_pixels_ == 0)) return rounding * error * diagonal_;
  if (!view_->lights.empty()) return 0;
  if (tolerated_ == 0) return rounding * error / scale;
  return rounding * error * larger(tolerated_, tolerated_pixels_ / scale);
}

float ErrorMeasure::error(const Mesh& mesh, const Buffer<Vec3f>& normals, EdgeId edge, double distance) const {
  if (camera_ == nullptr || (tolerated_ > 0 && tolerated_pixels_ == 0))
    return to_finite(diagonal_ > 0 ? distance / diagonal_ : 0);
  double seen = pixels(mesh, edge, distance);
  if (!view_->lights.empty()) seen *= light_weight(mesh, normals, edge, distance, *view_, *camera_);
  if (tolerated_ == 0) return to_finite(seen);
  return to_finite(lesser(distance / tolerated_, seen / tolerated_pixels_));
}

}  // namespace papilio
