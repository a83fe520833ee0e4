#include "view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "error.h"
#include "normals.h"

namespace papilio {
namespace {

/// The small positive number of section 3.2.2: the sine of the angle by which a face must be turned past
/// edge-on.
constexpr double away_epsilon = 1e-3;

/// However near the near plane is: what it is multiplied by stays a number.
constexpr double most_pixels_per_unit = 1e200;

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

/// The vertices [V] that are inside, each with its longest edge as radius.
std::vector<bool> find_inside(const Mesh& mesh, const Camera& camera) {
  const Topology& topology = mesh.topology;
  std::vector<double> radius_squared(topology.vertex_count, 0);
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    const uint32_t a = topology.origin[topology.half_edge[e]];
    const uint32_t b = topology.tip(topology.half_edge[e]);
    const Vec3d along = to_double(mesh.positions[b]) - to_double(mesh.positions[a]);
    radius_squared[a] = std::max(radius_squared[a], dot(along, along));
    radius_squared[b] = std::max(radius_squared[b], dot(along, along));
  }
  std::vector<bool> inside(topology.vertex_count);
  for (uint32_t v = 0; v < topology.vertex_count; ++v)
    inside[v] = !camera.is_outside(to_double(mesh.positions[v]), std::sqrt(radius_squared[v]));
  return inside;
}

enum : uint8_t { is_inside = 1, is_towards = 2, seen = 3 };

/// What of the above holds for each face [F].
std::vector<uint8_t> see_faces(const Mesh& mesh, const std::vector<Vec3f>& normals, const Camera& camera) {
  const std::vector<bool> inside = find_inside(mesh, camera);
  const auto position = [&](uint32_t v) { return to_double(mesh.positions[v]); };
  std::vector<uint8_t> faces(mesh.topology.face_count(), 0);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
    if (inside[corner[0]] || inside[corner[1]] || inside[corner[2]]) faces[f] |= is_inside;
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    if (!has_normal(normals[f]) || !camera.is_away(centroid, to_double(normals[f]))) faces[f] |= is_towards;
  }
  return faces;
}

}  // namespace

Camera::Camera(const View& view) : perspective_(view.projection == Projection::perspective), eye_(view.eye) {
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

  const double tan_y = std::tan(view.fov_y * std::numbers::pi / 360);
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

bool Camera::is_outside(Vec3d centre, double radius) const {
  return std::ranges::any_of(planes_, [&](const Plane& p) { return dot(p.normal, centre) - p.offset < -radius; });
}

bool Camera::is_away(Vec3d point, Vec3d normal) const { return facing(point, normal) < -away_epsilon; }

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
  return std::hypot(bx - ax, by - ay);
}

double Camera::pixels_per_unit(Vec3d point) const { return pixels_per_unit_at(dot(forward_, point - eye_)); }

double Camera::pixels_per_unit_at(double depth) const {
  return std::min(most_pixels_per_unit, perspective_ ? pixels_per_unit_ / std::max(near_, depth) : pixels_per_unit_);
}

std::vector<bool> hidden_faces(const Mesh& mesh, const std::vector<Vec3f>& normals, const Camera& camera) {
  const std::vector<uint8_t> seen_by = see_faces(mesh, normals, camera);
  std::vector<bool> hidden(seen_by.size());
  for (size_t f = 0; f < hidden.size(); ++f) hidden[f] = seen_by[f] != seen;
  return hidden;
}

void cull_by_view(const Mesh& mesh, const std::vector<Vec3f>& normals, const Camera& camera, double edge_pixels,
                  EdgeMarks& marks) {
  const Topology& topology = mesh.topology;
  const auto position = [&](uint32_t v) { return to_double(mesh.positions[v]); };

  const std::vector<uint8_t> faces = see_faces(mesh, normals, camera);
  std::vector<uint8_t> seen_by(topology.edge_count(), 0);
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) seen_by[topology.edge[h]] |= faces[Topology::face(h)];

  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    if (marks[e] == 0) continue;
    const uint32_t h = topology.half_edge[e];
    if (seen_by[e] != seen ||
        camera.projected_length(position(topology.origin[h]), position(topology.tip(h))) < edge_pixels)
      marks[e] = 0;
  }
}

}  // namespace papilio
