#include "tests/bench/head.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "papilio/mesh.h"
#include "tests/support/real_mesh.h"
#include "tests/support/simplify.h"

namespace papilio::bench {
namespace {

/// Closes the only hole of a mesh by a fan about the mean of its boundary.
TriangleMesh close_hole(const Mesh& open) {
  TriangleMesh mesh = open.triangles();
  const auto centre = static_cast<uint32_t>(mesh.positions.size());
  Vec3d sum;
  uint32_t rim = 0;
  for (uint32_t h = 0; h < open.topology.half_edge_count(); ++h) {
    if (open.topology.twin[h] != none) continue;
    mesh.triangles.push_back({open.topology.tip(h), open.topology.origin[h], centre});
    sum += to_double(open.positions[open.topology.origin[h]]);
    ++rim;
  }
  mesh.positions.push_back(to_float((1.0 / rim) * sum));
  return mesh;
}

}  // namespace

TriangleMesh head() {
  constexpr size_t faces = 2092;
  TriangleMesh coarse = test::simplify(close_hole(build_mesh(test::real_mesh("cgal/mannequin-devil.off"))), faces);
  if (coarse.triangles.size() != faces || build_mesh(coarse).topology.euler_characteristic() != 2)
    throw std::runtime_error("the head is not what it was");
  return coarse;
}

View front_view(const TriangleMesh& head) {
  const Box box = bounding_box(head.positions);
  const Vec3d centre = 0.5 * (to_double(box.min) + to_double(box.max));
  const Vec3d size = to_double(box.max) - to_double(box.min);
  View view;
  view.viewport = {640, 480};
  view.up = {0, 0, 1};  // the head faces -y
  view.target = centre;
  const double half_angle = view.fov_y / 2 * std::numbers::pi / 180;
  view.eye = centre - Vec3d{0, size.y / 2 + size.z / 2 / std::tan(half_angle), 0};
  return view;
}

}  // namespace papilio::bench
