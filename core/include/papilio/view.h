#pragma once

#include <array>
#include <vector>

#include "papilio/vec3.h"

namespace papilio {

enum class Projection { perspective, orthographic };

/// View of the mesh, in its own coordinates.
struct View {
  Vec3d eye{0, 0, 3};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  double fov_y = 45;                          ///< vertical field of view in degrees, 0 < fov_y < 180
  std::array<double, 2> viewport{1280, 720};  ///< width and height in pixels
  double near = 0;          ///< distance of the near plane; 0: a thousandth of the distance from eye to target
  double edge_pixels = 10;  ///< lower bound of a split edge's length in screen pixels; 0 turns the criterion off
  /// Lower bound of the surface's move at a split edge, in screen pixels at its distance, in whichever direction it
  /// moves. 0 turns the criterion off.
  double error_pixels = 0;
  /// Whether results by `error_pixels` alone, without lights or `edge_pixels`, are compared with the uniform surface.
  /// They are refined further until nothing visible is more than `error_pixels` from it. Takes most of the time.
  bool verify = true;
  /// Whether faces are visible from behind, as in open surfaces: then no face is culled as turned away.
  bool two_sided = false;
  /// Directions towards distant lights. With lights, the deviation in pixels is weighted by the change of shading over
  /// the edge, and by whether the edge is on the silhouette (lighting.h).
  std::vector<Vec3d> lights{};
  /// Projection. Orthographic rays are parallel; the height seen equals the perspective view's at the target's
  /// distance.
  Projection projection = Projection::perspective;
};

struct Box;

/// Returns the eye from which a viewer of `view.target` sees all of the box: from +z, or from -y if `view.up` points
/// along z. Uses all of `view` but the eye. If the view defines no picture, returns a point at which `Camera` reports
/// why.
[[nodiscard]] Vec3d framing_eye(const View& view, const Box& box);

}  // namespace papilio
