#pragma once

#include <cmath>

#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio::test {

/// A sphere of 20 * 4^levels faces with bumps of a tenth of its radius.
[[nodiscard]] inline TriangleMesh bumpy_sphere(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  TriangleMesh mesh = refine(build_mesh(icosahedron()), options).mesh.triangles();
  for (Vec3f& p : mesh.positions) {
    const Vec3f n = (1 / length(p)) * p;
    p = (1 + 0.1F * std::sin(5 * n.x) * std::sin(4 * n.y + 1) * std::sin(3 * n.z + 2)) * n;
  }
  return mesh;
}

}  // namespace papilio::test
