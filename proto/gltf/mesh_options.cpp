#include "proto/gltf/mesh_options.h"

#include <algorithm>
#include <cmath>

#include "papilio/trigonometry.h"
#include "proto/detail/find_packed.h"

namespace papilio::proto::gltf {
namespace {

/// Visibility of a sphere in a view.
struct Visibility {
  bool is_visible = false;
  double pixel = 0;  ///< length of a pixel at its nearest point, in the scene
};

double tangent_of_half(double degrees) {
  constexpr double steps = 1e6;  // steps per degree
  const SineCosine at =
      sine_and_cosine_of_turn(static_cast<uint64_t>(degrees / 2 * steps), static_cast<uint64_t>(360 * steps));
  return at.sine / at.cosine;
}

Vec3d unit(Vec3d v) {
  const double size = length(v);
  return size > 0 ? 1 / size * v : Vec3d{0, 0, 0};
}

Visibility visibility_of_sphere(const View& view, Vec3d centre, double radius) {
  const Vec3d forward = unit(view.target - view.eye);
  const Vec3d side = unit(cross(forward, view.up));
  const Vec3d above = cross(side, forward);
  const Vec3d from_eye = centre - view.eye;
  const double depth = dot(from_eye, forward);
  const double half = tangent_of_half(view.fov_y);
  const double to_target = length(view.target - view.eye);
  const double near = view.near > 0 ? view.near : to_target / 1000;
  const bool is_flat = view.projection == Projection::orthographic;
  const auto is_inside = [&](double across, double slope) {
    if (is_flat) return std::abs(across) - radius <= slope * to_target;
    return (std::abs(across) - slope * depth) / std::sqrt(1 + slope * slope) <= radius;
  };
  Visibility visibility;
  visibility.is_visible = depth + radius > near && is_inside(dot(from_eye, above), half) &&
                          is_inside(dot(from_eye, side), half * view.viewport[0] / view.viewport[1]);
  visibility.pixel = 2 * half * (is_flat ? to_target : std::max(depth - radius, near)) / view.viewport[1];
  return visibility;
}

/// Returns the view in the coordinates of a mesh that `map` moves into the scene.
View view_in_mesh(const View& view, const Affine& map, bool is_two_sided) {
  const Affine inverse = inverse_of_similarity(map);
  View inner = view;
  inner.two_sided = view.two_sided || is_two_sided;
  inner.eye = inverse.point(view.eye);
  inner.target = inverse.point(view.target);
  inner.up = unit(inverse.direction(view.up));
  inner.near = view.near / largest_scale(map);
  for (Vec3d& light : inner.lights) light = unit(inverse.direction(light));
  return inner;
}

/// Returns the length of the longest edge of a mesh.
double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    longest = std::max(longest, length(to_double(mesh.positions[mesh.topology.tip(h)]) -
                                       to_double(mesh.positions[mesh.topology.origin[h]])));
  return longest;
}

/// Bounds for the instances of a mesh, as lengths in the mesh.
struct Needs {
  bool is_visible = false;
  double tolerance = 0;    ///< smallest tolerance; 0: no bound
  double edge_length = 0;  ///< lower bound of split edges; 0: no bound
};

Needs needs_of(const Options& options, double scene_tolerance, const PlacedMesh& placed) {
  const Box box = bounding_box(placed.mesh.positions);
  Needs needs;
  const auto take = [&](double& least, double length) { least = needs.is_visible ? std::min(least, length) : length; };
  for (const std::vector<Affine>& maps : placed.maps)
    for (const Affine& map : maps) {
      const double scale = largest_scale(map);
      if (!(scale > 0)) continue;
      Visibility visibility{.is_visible = true, .pixel = 0};
      if (options.view)
        visibility = visibility_of_sphere(*options.view, map.point(box.centre()), scale * box.diagonal() / 2);
      if (!visibility.is_visible) continue;
      const double pixels = options.view ? options.view->error_pixels : 0;
      take(needs.tolerance, std::max(scene_tolerance, pixels * visibility.pixel) / scale);
      take(needs.edge_length, (options.view ? options.view->edge_pixels : 0) * visibility.pixel / scale);
      needs.is_visible = true;
    }
  return needs;
}

Options without_view(Options options) {
  options.view = std::nullopt;
  return options;
}

/// Returns the number of halvings that take the longest edge below `length`, plus one for edges that grow.
int halvings(double longest, double length, int most) {
  int count = 1;
  for (; count < most && longest > length; longest /= 2) ++count;
  return count;
}

}  // namespace

std::optional<Options> options_of_mesh(const Options& options, double scene_diagonal, const PlacedMesh& placed) {
  const double scene_tolerance = options.tolerance * scene_diagonal;
  const Needs needs = needs_of(options, scene_tolerance, placed);
  if (!needs.is_visible || !(placed.diagonal > 0)) return std::nullopt;
  const bool is_shown_once = placed.maps.size() == 1 && std::ranges::all_of(placed.maps[0], [&](const Affine& map) {
                               return is_similarity(map) && are_alike(map, placed.maps[0][0]);
                             });
  const bool keeps_view = options.view && is_shown_once;
  std::optional<Options> own = keeps_view ? options : without_view(options);
  detail::end_with_detail(*own, placed.mesh);
  if (keeps_view)
    own->view = view_in_mesh(*options.view, placed.maps[0][0], placed.is_two_sided);
  else if (needs.edge_length > 0)
    own->levels = std::min(own->levels, halvings(longest_edge(placed.mesh), needs.edge_length, own->levels));
  const double tolerance = keeps_view ? scene_tolerance / largest_scale(placed.maps[0][0]) : needs.tolerance;
  own->tolerance = std::min(1.0, tolerance / placed.diagonal);
  return own;
}

}  // namespace papilio::proto::gltf
