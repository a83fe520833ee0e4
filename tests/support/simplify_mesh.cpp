// simplify_mesh IN OUT FACES: makes a coarse test mesh out of a fine one.
//
// Reads .obj, .off or .ply and writes .obj or .off with FACES triangles, by quadric edge collapse (Garland
// and Heckbert 1997, in OpenMesh). The result is manifold, and closed when the input is. A closed mesh has an
// even number of faces: an odd FACES is rounded down. Exit status: 0, 1 (the mesh cannot be used or written)
// or 2 (usage).

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using Triangle = std::array<int, 3>;

/// Vertices go into the mesh, faces into a list: OpenMesh's own importer mends complex edges by copying
/// vertices, without saying so, and its library aborts on the faces it cannot take.
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

/// Throws unless every face has three different vertices of `mesh`, every coordinate is finite, and no edge
/// has more than two faces or two that disagree on its direction.
void check_faces(const Mesh& mesh, const std::vector<Triangle>& triangles) {
  const int vertices = static_cast<int>(mesh.n_vertices());
  std::set<std::pair<int, int>> half_edges;
  for (size_t face = 0; face < triangles.size(); ++face) {
    const std::string name = "face " + std::to_string(face);
    for (int k = 0; k < 3; ++k) {
      const int from = triangles[face][k];
      const int to = triangles[face][(k + 1) % 3];
      if (from < 0 || from >= vertices) throw std::runtime_error(name + " names a vertex that does not exist");
      if (from == to) throw std::runtime_error(name + " uses a vertex twice");
      if (!half_edges.emplace(from, to).second) {
        throw std::runtime_error(name + " is on an edge of more than two faces, or is turned against its neighbour");
      }
      for (const double coordinate : mesh.point(OpenMesh::VertexHandle(from))) {
        if (!std::isfinite(coordinate)) throw std::runtime_error(name + " has a coordinate that is not finite");
      }
    }
  }
}

/// Throws where the faces around a vertex are more than one fan.
void check_vertices(const Mesh& mesh) {
  for (const auto vertex : mesh.vertices()) {
    if (!mesh.is_manifold(vertex)) {
      throw std::runtime_error("vertex " + std::to_string(vertex.idx()) + " joins two parts of the surface");
    }
  }
}

bool is_closed(const Mesh& mesh) {
  return std::none_of(mesh.halfedges_begin(), mesh.halfedges_end(),
                      [&mesh](OpenMesh::HalfedgeHandle half_edge) { return mesh.is_boundary(half_edge); });
}

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (const auto face : mesh.faces()) {
    Triangle triangle{};
    std::ranges::transform(face.vertices().to_vector(), triangle.begin(), [](const auto& v) { return v.idx(); });
    triangles.push_back(triangle);
  }
  return triangles;
}

Mesh read(const std::string& file) {
  Mesh mesh;
  FaceListImporter importer(mesh);
  OpenMesh::IO::Options options;
  if (!OpenMesh::IO::IOManager().read(file, importer, options) || importer.triangles().empty()) {
    throw std::runtime_error("no mesh could be read from it");
  }
  check_faces(mesh, importer.triangles());
  for (const auto& [a, b, c] : importer.triangles()) {
    using Vertex = OpenMesh::VertexHandle;
    if (!mesh.add_face(Vertex(a), Vertex(b), Vertex(c)).is_valid()) {
      throw std::runtime_error("the surface is not manifold");
    }
  }
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  check_vertices(mesh);
  return mesh;
}

void simplify(Mesh& mesh, size_t faces) {
  const bool closed = is_closed(mesh);
  mesh.update_face_normals();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
  decimater.add(quadric);
  decimater.add(flipping);
  decimater.module(quadric).unset_max_err();
  if (!decimater.initialize()) throw std::runtime_error("OpenMesh's decimater did not start");
  decimater.decimate_to_faces(0, faces);
  mesh.garbage_collection();

  if (mesh.n_faces() > faces) {
    throw std::runtime_error("no further edge can be collapsed at " + std::to_string(mesh.n_faces()) + " faces");
  }
  check_faces(mesh, triangles_of(mesh));
  check_vertices(mesh);
  if (is_closed(mesh) != closed)
    throw std::runtime_error("the result is closed where the input is open, or the reverse");
}

/// Writes beside `file` and renames, so that nobody meets half a mesh.
void write(const Mesh& mesh, const std::filesystem::path& file) {
  const bool off = file.extension() == ".off";
  const std::filesystem::path unfinished = file.string() + ".unfinished";
  std::ofstream out(unfinished);
  out.precision(std::numeric_limits<float>::max_digits10);
  if (off) out << "OFF\n" << mesh.n_vertices() << ' ' << mesh.n_faces() << " 0\n";
  for (const auto vertex : mesh.vertices()) out << (off ? "" : "v ") << mesh.point(vertex) << '\n';
  for (const auto& [a, b, c] : triangles_of(mesh)) {
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
    simplify(mesh, faces);
    write(mesh, arguments[1]);
    std::cerr << arguments[1] << ": " << mesh.n_vertices() << " vertices, " << mesh.n_faces() << " faces of " << before
              << '\n';
  } catch (const std::exception& error) {
    std::cerr << "simplify_mesh: " << arguments[0] << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}
