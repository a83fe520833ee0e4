#include "tests/support/real_mesh.h"

#include <cstdlib>
#include <stdexcept>

#include "client/mesh_file/mesh_file.h"

namespace papilio::test {

TriangleMesh real_mesh(const std::string& name) {
  const char* folder = std::getenv("PAPILIO_MESHES");
  if (folder == nullptr) throw std::runtime_error("PAPILIO_MESHES is not set; run ./dev test");
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  return client::read_triangles(path, client::format_of(path));
}

}  // namespace papilio::test
