#include "criteria/camera.h"

#include <algorithm>
#include <cmath>

#include "base/hypotenuse.h"
#include "base/trigonometry.h"
#include "papilio/error.h"

namespace papilio {
namespace {

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require(bool good, const char* option, const char* what) {
  if (!good) throw Error(Fault::bad_option, what, option);
}

void check(const View& view) {
  require(is_finite(view.eye), "view.eye", "The eye must be three finite numbers.");
  require(is_finite(view.target), "view.target", "The target must be three finite numbers.");
  require(is_finite(view.up), "view.up", "The up direction must be three finite numbers.");
  require(view.fov_y > 0 && view.fov_y < 180, "view.fov_y", "The field of view must lie between 0 and 180 degrees.");
  require(view.viewport[0] > 0 && view.viewport[1] > 0 && std::isfinite(view.viewport[0]) &&
              std::isfinite(view.viewport[1]),
          "view.viewport", "The viewport must be two positive numbers of pixels.");
  require(view.near >= 0 && std::isfinite(view.near), "view.near", "The near plane's distance must not be negative.");
  require(view.edge_pixels >= 0, "view.edge_pixels", "The length in pixels must not be negative.");
  require(view.error_pixels >= 0, "view.error_pixels", "The deviation in pixels must not be negative.");
  for (Vec3d light : view.lights)
    require(length(light) > 0 && std::isfinite(length(light)), "view.lights",
            "Each light must be a direction, three finite numbers that are not all zero.");
}

Vec3d unit(Vec3d v) { return (1 / length(v)) * v; }

}  // namespace

Camera::Camera(const View& view)
    : perspective_(view.projection == Projection::perspective), two_sided_(view.two_sided), eye_(view.eye) {
  check(view);
  const double distance = length(view.target - view.eye);
  require(distance > 0 && std::isfinite(distance), "view.target",
          "The target must be another point than the eye, at a distance that can be computed.");
  forward_ = unit(view.target - view.eye);
  require(length(view.up) > 0 && std::isfinite(length(view.up)), "view.up",
          "The up direction must have a length that can be computed.");
  const Vec3d sideways = cross(forward_, unit(view.up));
  require(length(sideways) > 1e-9, "view.up",
          "The up direction must not point along the line of sight. Choose another up.");
  right_ = unit(sideways);
  up_ = cross(right_, forward_);
  near_ = view.near > 0 ? view.near : 1e-3 * distance;

  const double tan_y = tangent_of_degrees(view.fov_y / 2);
  const double tan_x = tan_y * view.viewport[0] / view.viewport[1];
  const double half_height = perspective_ ? tan_y : tan_y * distance;
  pixels_per_unit_ = view.viewport[1] / (2 * half_height);
  const auto side = [&](Vec3d direction, double tangent) {
    if (!perspective_) return Plane{-1.0 * direction, -dot(direction, eye_) - tangent * distance};
    const Vec3d normal = unit(tangent * forward_ - direction);
    return Plane{normal, dot(normal, eye_)};
  };
  planes_ = {side(right_, tan_x), side(-1.0 * right_, tan_x), side(up_, tan_y), side(-1.0 * up_, tan_y),
             Plane{forward_, dot(forward_, eye_) + near_}};
}

double Camera::highest_pixels_per_unit(const Box& box) const {
  constexpr double rounding = 1 + 1e-9;
  double depth = -dot(forward_, eye_);
  const auto add = [&](double n, double low, double high) { depth += std::min(n * low, n * high); };
  add(forward_.x, box.min.x, box.max.x);
  add(forward_.y, box.min.y, box.max.y);
  add(forward_.z, box.min.z, box.max.z);
  return rounding * pixels_per_unit_at(depth);
}

double Camera::facing(Vec3d point, Vec3d normal) const {
  if (!perspective_) return -dot(forward_, normal);
  const Vec3d sight = point - eye_;
  const double distance = length(sight);
  return distance > 0 ? -dot(sight, normal) / distance : 0;
}

std::array<double, 2> Camera::project(Vec3d relative) const {
  const double scale = pixels_per_unit_at(dot(forward_, relative));
  return {scale * dot(right_, relative), scale * dot(up_, relative)};
}

double Camera::projected_length(Vec3d a, Vec3d b) const {
  a -= eye_;
  b -= eye_;
  const double depth_a = dot(forward_, a);
  const double depth_b = dot(forward_, b);
  if (depth_a < near_ && depth_b < near_) return 0;
  if (depth_a < near_) a += ((near_ - depth_a) / (depth_b - depth_a)) * (b - a);
  if (depth_b < near_) b += ((near_ - depth_b) / (depth_a - depth_b)) * (a - b);
  const auto [ax, ay] = project(a);
  const auto [bx, by] = project(b);
  return hypotenuse(bx - ax, by - ay);
}

}  // namespace papilio
