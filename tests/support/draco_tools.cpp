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

/// Temporary folder, removed by its destructor.
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

void run(const std::string& program, const fs::path& in, const fs::path& out) {
  const std::string command = program + " -i " + in.string() + " -o " + out.string() + " > /dev/null 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error(program + " refuses its input");
}

std::string bytes_of(const draco::EncoderBuffer& buffer) { return {buffer.data(), buffer.size()}; }

}  // namespace

TriangleMesh decode_with_draco_decoder(std::string_view draco) {
  const Folder folder;
  client::write_atomically(folder.path() / "in.drc", draco);
  run("draco_decoder", folder.path() / "in.drc", folder.path() / "out.ply");
  return client::read_triangles(folder.path() / "out.ply", client::Format::ply);
}

proto::FormattedMesh decode_to_obj(std::string_view draco, size_t* positions) {
  const Folder folder;
  const fs::path out = folder.path() / "out.obj";
  client::write_atomically(folder.path() / "in.drc", draco);
  run("draco_decoder", folder.path() / "in.drc", out);
  if (positions != nullptr) {
    const std::string text = client::read_bytes(out, client::kMaxFileBytes);
    *positions = 0;
    for (size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) ++*positions;
    *positions += text.starts_with("v ") ? 1 : 0;
  }
  return client::read_triangles(out, client::Format::obj);
}

std::string encode_with_draco_encoder(const proto::FormattedMesh& mesh, int compression) {
  const Folder folder;
  client::write_triangles(folder.path() / "in.obj", client::Format::obj, mesh, mesh.format);
  run("draco_encoder -qp 14 -qt 14 -cl " + std::to_string(compression), folder.path() / "in.obj",
      folder.path() / "out.drc");
  return client::read_bytes(folder.path() / "out.drc", client::kMaxFileBytes);
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
