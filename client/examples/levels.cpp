// levels: every level of a refinement, as it is made.

#include <papilio/refine.h>

#include <cstdio>
#include <exception>

int main() try {
  const papilio::TriangleMesh octahedron{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

  papilio::Options options;
  options.levels = 3;

  papilio::Hooks hooks;
  hooks.on_level = [](const papilio::Level& level) {  // the mesh is valid during the call: copy what you keep
    std::printf("level %d: %u faces%s\n", level.level, level.mesh.topology.face_count(),
                level.last ? ", the last" : "");
  };
  const papilio::Result result = papilio::refine(papilio::build_mesh(octahedron), options, hooks);
  std::printf("a further level would move the surface by about %.1g of its size\n", result.error);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
