// views: one mesh refined for several views. The first view computes, the next ones reuse.

#include <papilio/refine.h>

#include <cstdio>
#include <exception>

int main() try {
  const papilio::TriangleMesh octahedron{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

  papilio::Options options;
  options.levels = 6;
  options.view = papilio::View{};
  options.view->edge_pixels = 0;
  options.view->error_pixels = 0.5;  // below what is visible

  // Keeps at most 64 MiB between the views.
  const papilio::PreparedMesh mesh(papilio::build_mesh(octahedron), options, uint64_t{64} << 20);
  for (const papilio::Vec3d eye : {papilio::Vec3d{0, 0, 3}, papilio::Vec3d{0.5, 0, 3}, papilio::Vec3d{0, 0, 12}}) {
    options.view->eye = eye;
    const papilio::Result result = papilio::refine(mesh, options);
    std::printf("from %g %g %g: %u faces, %.2f pixels off\n", eye.x, eye.y, eye.z, result.mesh.topology.face_count(),
                result.error_pixels);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
