#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "client/mesh_file/mesh_file.h"

// Mesh files in a temporary folder, and meshes with extreme contents.

namespace papilio::client {

namespace fs = std::filesystem;
using testing::HasSubstr;

inline const std::vector<Format> kFormats{Format::obj, Format::ply, Format::off, Format::stl};

inline std::string extension_of(Format format) {
  switch (format) {
    case Format::obj:
      return ".obj";
    case Format::ply:
      return ".ply";
    case Format::off:
      return ".off";
    case Format::stl:
      return ".stl";
    case Format::glb:
      return ".glb";
    case Format::gltf:
      return ".gltf";
    case Format::drc:
      break;
  }
  return ".drc";
}

/// Temporary folder per test.
class MeshFileTest : public testing::Test {
 protected:
  MeshFileTest() {
    std::string pattern = (fs::temp_directory_path() / "papilio-mesh-file-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~MeshFileTest() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }

  fs::path put(const std::string& name, std::string_view bytes) const {
    fs::remove(path(name));  // some file systems flush a file that is truncated and rewritten
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  [[nodiscard]] TriangleMesh read(Format format, std::string_view bytes) const {
    return read_triangles(put("in" + extension_of(format), bytes), format);
  }

  /// Returns the error of reading these bytes; empty if they are read.
  [[nodiscard]] std::string complaint(Format format, std::string_view bytes) const {
    try {
      (void)read(format, bytes);
      return "";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("in" + extension_of(format)));
      return error.what();
    }
  }

  [[nodiscard]] std::string written(Format format, const TriangleMesh& mesh) const {
    write_triangles(path("out" + extension_of(format)), format, mesh);
    return read_bytes(path("out" + extension_of(format)), kMaxFileBytes);
  }

  [[nodiscard]] TriangleMesh round_trip(Format format, const TriangleMesh& mesh) const {
    write_triangles(path("trip" + extension_of(format)), format, mesh);
    return read_triangles(path("trip" + extension_of(format)), format);
  }

  [[nodiscard]] size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Contents that OpenMesh refuses: repeated, degenerate and non-manifold faces, an unused vertex.
inline TriangleMesh untidy() {
  TriangleMesh mesh = tetrahedron();
  mesh.positions.push_back({7, 7, 7});
  mesh.positions.push_back(mesh.positions[0]);
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 1}, {1, 2, 0}, {0, 0, 1}, {3, 3, 3}, {0, 1, 5}, {5, 1, 2}});
  return mesh;
}

/// Floats of every size, zeros of both signs, the smallest and the largest.
inline TriangleMesh hard_numbers() {
  using Limits = std::numeric_limits<float>;
  TriangleMesh mesh{{{0.1F, -0.0F, 1.0F / 3},
                     {Limits::min(), Limits::denorm_min(), -Limits::denorm_min()},
                     {Limits::max(), Limits::lowest(), Limits::epsilon()}},
                    {{0, 1, 2}}};
  std::mt19937 random(11);
  const auto any_float = [&random] {
    for (;;)
      if (const auto value = std::bit_cast<float>(static_cast<uint32_t>(random())); std::isfinite(value)) return value;
  };
  for (uint32_t i = 3; i < 3000; ++i) {
    const float x = any_float(), y = any_float(), z = any_float();
    mesh.positions.push_back({x, y, z});
    mesh.triangles.push_back({i, i - 1, i - 3});
  }
  return mesh;
}

inline std::vector<uint32_t> bits(const TriangleMesh& mesh) {
  std::vector<uint32_t> all;
  for (const Vec3f& p : mesh.positions)
    for (const float coordinate : {p.x, p.y, p.z}) all.push_back(std::bit_cast<uint32_t>(coordinate));
  return all;
}

/// Returns the mesh with three separate positions per triangle, as in STL.
inline TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh apart;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<uint32_t>(apart.positions.size());
    for (const uint32_t vertex : triangle) apart.positions.push_back(mesh.positions[vertex]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

inline std::vector<fs::path> real_meshes() {
  std::vector<fs::path> found;
  const char* folder = std::getenv("PAPILIO_MESHES");
  if (folder == nullptr || !fs::is_directory(fs::path(folder) / "cgal")) return found;
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / "cgal"))
    if (entry.path().extension() == ".off") found.push_back(entry.path());
  return found;
}

// Parts of valid files.

inline constexpr std::string_view kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
inline constexpr std::string_view kOffBody = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
inline constexpr std::string_view kStlText =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid a\n";

inline std::string ply_header(const std::string& format, const std::string& vertex, const std::string& face) {
  return "ply\nformat " + format + " 1.0\ncomment element face 7\nobj_info end_header\nelement vertex 3\n" + vertex +
         "element face 1\n" + face + "end_header\n";
}

inline const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
inline const std::string kIndices = "property list uchar int vertex_indices\n";
inline const std::string kPlyText = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <class Number>
void put_number(std::string& bytes, Number number, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof number>>(number);
  if (order != std::endian::native) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

inline std::string binary_stl(const TriangleMesh& mesh, const std::string& header) {
  std::string bytes = header;
  bytes.resize(80);
  put_number(bytes, static_cast<uint32_t>(mesh.triangles.size()), std::endian::little);
  for (const Triangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put_number(bytes, 0.0F, std::endian::little);
    for (const uint32_t vertex : triangle) {
      const Vec3f p = mesh.positions[vertex];
      for (const float coordinate : {p.x, p.y, p.z}) put_number(bytes, coordinate, std::endian::little);
    }
    bytes += "\x7f\xff";
  }
  return bytes;
}

}  // namespace papilio::client
