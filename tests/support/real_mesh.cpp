#include "tests/support/real_mesh.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "client/mesh_file/mesh_file.h"
#include "proto/draco_reader.h"

namespace papilio::test {
namespace {

std::filesystem::path meshes_folder() {
  const char* folder = std::getenv("PAPILIO_MESHES");
  if (folder == nullptr) throw std::runtime_error("PAPILIO_MESHES is not set; run ./dev test or ./dev bench");
  return folder;
}

}  // namespace

TriangleMesh real_mesh(const std::string& name) {
  const std::filesystem::path path = meshes_folder() / name;
  const client::Format format = client::format_of(path);
  if (format == client::Format::drc) return proto::read_draco(client::read_bytes(path, client::kMaxFileBytes), {});
  return client::read_triangles(path, format);
}

std::vector<std::filesystem::path> cgal_mesh_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(meshes_folder() / "cgal"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace papilio::test
