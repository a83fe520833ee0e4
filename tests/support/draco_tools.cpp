#include "tests/support/draco_tools.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "client/mesh_file/mesh_file.h"

namespace papilio::test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "papilio-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string bytes_of(const draco::EncoderBuffer& buffer) { return {buffer.data(), buffer.size()}; }

}  // namespace

TriangleMesh decode_with_draco_decoder(std::string_view draco) {
  const Folder folder;
  const fs::path in = folder.path() / "in.drc";
  const fs::path out = folder.path() / "out.ply";
  client::write_atomically(in, draco);
  const std::string command = "draco_decoder -i " + in.string() + " -o " + out.string() + " > /dev/null 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("draco_decoder refuses the stream");
  return client::read_triangles(out, client::Format::ply);
}

std::string encode_with_draco(const TriangleMesh& mesh, Method method, bool with_metadata) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(mesh.triangles.size()));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle t = mesh.triangles[f];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(static_cast<uint32_t>(f)), &mesh.positions[t[0]],
                                      &mesh.positions[t[1]], &mesh.positions[t[2]]);
  }
  const std::unique_ptr<draco::Mesh> built = builder.Finalize();
  if (with_metadata) {
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    metadata->AddEntryString("maker", "a test");
    auto inner = std::make_unique<draco::Metadata>();
    inner->AddEntryInt("answer", 42);
    metadata->AddSubMetadata("inner", std::move(inner));
    built->AddMetadata(std::move(metadata));
  }
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 11);
  encoder.SetEncodingMethod(method == Method::edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                          : draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(*built, &buffer).ok()) throw std::runtime_error("Draco refuses the mesh");
  return bytes_of(buffer);
}

std::string encode_point_cloud(const TriangleMesh& mesh) {
  draco::PointCloudBuilder builder;
  builder.Start(static_cast<uint32_t>(mesh.positions.size()));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (uint32_t p = 0; p < mesh.positions.size(); ++p)
    builder.SetAttributeValueForPoint(position, draco::PointIndex(p), &mesh.positions[p]);
  const std::unique_ptr<draco::PointCloud> cloud = builder.Finalize(false);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  if (!encoder.EncodePointCloudToBuffer(*cloud, &buffer).ok()) throw std::runtime_error("Draco refuses the cloud");
  return bytes_of(buffer);
}

}  // namespace papilio::test
