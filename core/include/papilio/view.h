#pragma once

#include <array>
#include <vector>

#include "papilio/vec3.h"

namespace papilio {

enum class Projection { perspective, orthographic };

/// Where the mesh is seen from, in its own coordinates.
struct View {
  Vec3d eye{0, 0, 3};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  double fov_y = 45;                          ///< vertical field of view in degrees, 0 < fov_y < 180
  std::array<double, 2> viewport{1280, 720};  ///< width and height in pixels
  double near = 0;          ///< distance of the near plane; 0: a thousandth of the distance from eye to target
  double edge_pixels = 10;  ///< an edge that looks shorter than this stays whole; 0 turns the criterion off
  /// Edges are split only where the surface would move by at least this many pixels, as large as the move looks from
  /// its distance, whichever way it goes; 0 turns the criterion off.
  double error_pixels = 0;
  /// Whether results by error_pixels alone, without lights and `edge_pixels`, are compared with the uniform surface,
  /// and refined further until nothing that the picture shows is further from it than so many pixels. Takes most of the
  /// time.
  bool verify = true;
  /// Whether backs are shown too, as those of open surfaces seldom are: then no face is turned away.
  bool two_sided = false;
  /// Directions towards lights far away. With them the deviation in pixels is weighed by how much the shading changes
  /// over the edge and by whether it is on the silhouette (lighting.h).
  std::vector<Vec3d> lights{};
  /// Orthographic: parallel rays; the height seen is what the perspective view sees at the target's distance.
  Projection projection = Projection::perspective;
};

struct Box;

/// Returns the eye from which all of the box is in the picture of a viewer that looks at `view.target`: from +z, or
/// from -y where `view.up` points along z. Uses everything of `view` but the eye. Where the view defines no picture,
/// returns a point at which `Camera` names the reason.
[[nodiscard]] Vec3d framing_eye(const View& view, const Box& box);

}  // namespace papilio
