#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "papilio/mesh.h"
#include "papilio/view.h"

namespace papilio {
namespace {

constexpr double margin = 1.05;                ///< factor of the distance, which keeps the box off the picture's border
constexpr double least_distance = 0.01;        ///< share of the diagonal, if the target is between the eye and the box
constexpr double most_parallel_cosine = 0.99;  ///< upper bound: beyond it, `up` is along the line of sight

}  // namespace

Vec3d framing_eye(const View& view, const Box& box) {
  const double up_length = length(view.up);
  if (!(up_length > 0 && std::isfinite(up_length))) return view.target + Vec3d{0, 0, 1};  // `Camera` reports `view.up`
  const Vec3d up = (1 / up_length) * view.up;
  const bool is_z_up = std::abs(up.z) > most_parallel_cosine;
  const Vec3d back = is_z_up ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};  // direction from the target to the eye
  const Vec3d sideways = cross(up, back);
  const Vec3d right = (1 / length(sideways)) * sideways;
  const Vec3d above = cross(back, right);

  const double tan_y = tangent_of_degrees(view.fov_y / 2);
  const double tan_x = tan_y * view.viewport[0] / view.viewport[1];
  const bool is_perspective = view.projection == Projection::perspective;
  double distance = least_distance * box.diagonal();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d point{(corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                      (corner & 4) != 0 ? box.max.z : box.min.z};
    const Vec3d offset = point - view.target;
    const double towards_eye = dot(offset, back);
    const double needed = std::max(std::abs(dot(offset, right)) / tan_x, std::abs(dot(offset, above)) / tan_y);
    distance = std::max({distance, is_perspective ? towards_eye + needed : std::max(towards_eye, needed)});
  }
  return view.target + (margin * distance + view.near) * back;
}

}  // namespace papilio
