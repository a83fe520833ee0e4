// simplify_mesh IN OUT FACES: makes a coarse test mesh out of a fine one.
//
// Reads .obj, .off or .ply and writes .obj or .off with FACES triangles, by quadric edge collapse (Garland
// and Heckbert 1997, in OpenMesh). The result is manifold, and closed when the input is. A closed mesh has an
// even number of faces: an odd FACES is rounded down. Exit status: 0, 1 (the mesh cannot be used or written)
// or 2 (usage).

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/decimation.h"

namespace {

namespace test = papilio::test;
using Mesh = test::DecimationMesh;
using Triangle = test::DecimationTriangle;

/// Importer of vertices into the mesh and of faces into a list: OpenMesh's importer silently repairs complex
/// edges by duplicating vertices, and its library aborts on faces that it cannot add.
class FaceListImporter : public OpenMesh::IO::ImporterT<Mesh> {
 public:
  explicit FaceListImporter(Mesh& mesh) : ImporterT(mesh) {}

  using ImporterT::add_face;
  OpenMesh::FaceHandle add_face(const VHandles& corners) override {
    for (size_t i = 2; i < corners.size(); ++i) {
      triangles_.push_back({corners[0].idx(), corners[i - 1].idx(), corners[i].idx()});
    }
    return OpenMesh::FaceHandle();
  }
  [[nodiscard]] size_t n_faces() const override { return triangles_.size(); }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  std::vector<Triangle> triangles_;
};

Mesh read(const std::string& file) {
  Mesh mesh;
  FaceListImporter importer(mesh);
  OpenMesh::IO::Options options;
  if (!OpenMesh::IO::IOManager().read(file, importer, options) || importer.triangles().empty()) {
    throw std::runtime_error("no mesh could be read from it");
  }
  test::add_faces(mesh, importer.triangles());
  return mesh;
}

/// Writes a temporary file and renames it to `file`, so that readers never see a partial mesh.
void write(const Mesh& mesh, const std::filesystem::path& file) {
  const bool off = file.extension() == ".off";
  const std::filesystem::path unfinished = file.string() + ".unfinished";
  std::ofstream out(unfinished);
  out.precision(std::numeric_limits<float>::max_digits10);
  if (off) out << "OFF\n" << mesh.n_vertices() << ' ' << mesh.n_faces() << " 0\n";
  for (const auto vertex : mesh.vertices()) out << (off ? "" : "v ") << mesh.point(vertex) << '\n';
  for (const auto& [a, b, c] : test::triangles_of(mesh)) {
    if (off) {
      out << "3 " << a << ' ' << b << ' ' << c << '\n';
    } else {
      out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
    }
  }
  out.close();
  if (!out) throw std::runtime_error("cannot write " + unfinished.string());
  std::filesystem::rename(unfinished, file);
}

bool has_extension(const std::filesystem::path& file, std::initializer_list<const char*> extensions) {
  return std::ranges::find(extensions, file.extension().string()) != extensions.end();
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  size_t faces = 0;
  const auto is_count = [&faces](const std::string& text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), faces);
    return error == std::errc() && end == text.data() + text.size() && faces >= 4;
  };
  if (arguments.size() != 3 || !has_extension(arguments[0], {".obj", ".off", ".ply"}) ||
      !has_extension(arguments[1], {".obj", ".off"}) || !is_count(arguments[2])) {
    std::cerr << "usage: simplify_mesh IN.(obj|off|ply) OUT.(obj|off) FACES   (FACES: 4 or more)\n";
    return 2;
  }
  try {
    Mesh mesh = read(arguments[0]);
    const size_t before = mesh.n_faces();
    test::decimate(mesh, faces);
    write(mesh, arguments[1]);
    std::cerr << arguments[1] << ": " << mesh.n_vertices() << " vertices, " << mesh.n_faces() << " faces of " << before
              << '\n';
  } catch (const std::exception& error) {
    std::cerr << "simplify_mesh: " << arguments[0] << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}
