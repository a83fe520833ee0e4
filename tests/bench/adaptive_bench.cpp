#include <memory>

#include "papilio/refine.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Adaptive red-green refinement in three levels to a fifth to two fifths of the uniform result, per output triangle,
// compared with our uniform refinement in two levels of about as many triangles. One thread, without tension.

namespace papilio::bench {
namespace {

Options adaptive_options() {
  Options options;
  options.levels = 3;
  options.tension = Tension::off;
  options.edges = false;
  return options;
}

void add_row(const std::string& name, const TriangleMesh& triangles, const Options& options) {
  const auto coarse = std::make_shared<Mesh>(build_mesh(triangles));
  Options uniform = adaptive_options();
  uniform.levels = 2;
  const double faces = refine(*coarse, options).mesh.topology.face_count();
  const double uniform_faces = 16.0 * coarse->topology.face_count();
  const auto time = [coarse](const Options& how) {
    Mesh mesh = *coarse;
    return seconds([&] { (void)refine(std::move(mesh), how); });
  };
  const auto percent = static_cast<int>(100 * faces / (4 * uniform_faces) + 0.5);
  add({.name = "adaptive/" + name + "/" + std::to_string(percent) + " percent",
       .divisor = faces,
       .unit = "ns/triangle out",
       .ours = [=] { return time(options); },
       .peer = [=] { return time(uniform) * faces / uniform_faces; }});
}

}  // namespace

void add_adaptive() {
  const TriangleMesh triangles = test::real_mesh("elephant20k.drc");
  Options options = adaptive_options();
  options.flatness = {0.98, 0.99, 0.995};
  add_row("flatness", triangles, options);
  options.flatness = {0.99, 0.995, 0.9975};
  add_row("flatness", triangles, options);
  options = adaptive_options();
  options.tolerance = 2e-5;
  add_row("tolerance", triangles, options);
  // Only the part visible from nearby: one piece of the surface, in contrast to the scattered pieces of the others.
  options = adaptive_options();
  const Box box = bounding_box(triangles.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + Vec3d{0, 0, 0.5 * box.diagonal()};
  view.edge_pixels = 0;
  options.view = view;
  add_row("view", triangles, options);
}

}  // namespace papilio::bench
