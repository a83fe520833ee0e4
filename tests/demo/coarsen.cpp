// coarsen IN OUT FACES: writes a mesh file (.obj .ply .off .stl) with at most FACES of the input's triangles, by
// quadric edge collapse. Exit status: 0, 1 (the mesh cannot be used or written) or 2 (usage).

#include <cstdlib>
#include <exception>
#include <iostream>

#include "client/mesh_file/mesh_file.h"
#include "tests/support/collapse_optimally.h"

int main(int argc, char** argv) {
  const unsigned long faces = argc == 4 ? std::strtoul(argv[3], nullptr, 10) : 0;
  if (faces == 0) {
    std::cerr << "usage: coarsen IN OUT FACES\n";
    return 2;
  }
  try {
    using namespace papilio;
    const TriangleMesh fine = client::read_triangles(argv[1], client::format_of(argv[1]));
    client::write_triangles(argv[2], client::format_of(argv[2]), test::collapse_optimally(fine, faces));
  } catch (const std::exception& error) {
    std::cerr << "coarsen: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
