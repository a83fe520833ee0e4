#include "tests/support/real_mesh.h"

#include <cstdlib>
#include <stdexcept>

#include "client/mesh_file/mesh_file.h"
#include "proto/draco_reader.h"

namespace papilio::test {

TriangleMesh real_mesh(const std::string& name) {
  const char* folder = std::getenv("PAPILIO_MESHES");
  if (folder == nullptr) throw std::runtime_error("PAPILIO_MESHES is not set; run ./dev test or ./dev bench");
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  const client::Format format = client::format_of(path);
  if (format == client::Format::drc) return proto::read_draco(client::read_bytes(path, client::kMaxFileBytes), {});
  return client::read_triangles(path, format);
}

}  // namespace papilio::test
