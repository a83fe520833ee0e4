// Under the sanitizers g++ warns of uninitialised points, which OpenMesh fills in later.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "tests/support/mesh_file_fixture.h"

// OpenMesh as an independent reader and writer of valid files.

namespace papilio::client {
namespace {

using OpenMeshTriangles = OpenMesh::TriMesh_ArrayKernelT<>;

TriangleMesh from_openmesh(const OpenMeshTriangles& mesh) {
  TriangleMesh result;
  for (const auto vertex : mesh.vertices()) {
    const auto p = mesh.point(vertex);
    result.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto face : mesh.faces()) {
    Triangle triangle{};
    size_t corner = 0;
    for (const auto vertex : mesh.fv_range(face)) triangle[corner++] = static_cast<uint32_t>(vertex.idx());
    // OpenMesh's faces may begin at any corner.
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    result.triangles.push_back(triangle);
  }
  return result;
}

TriangleMesh with_smallest_first(TriangleMesh mesh) {
  for (Triangle& triangle : mesh.triangles) std::ranges::rotate(triangle, std::ranges::min_element(triangle));
  return mesh;
}

/// Returns the triangles of a soup as indices into `positions`.
TriangleMesh welded(const TriangleMesh& apart, const Buffer<Vec3f>& positions) {
  TriangleMesh mesh{positions, apart.triangles};
  for (Triangle& triangle : mesh.triangles)
    for (uint32_t& vertex : triangle)
      vertex = static_cast<uint32_t>(std::ranges::find(positions, apart.positions[vertex]) - positions.begin());
  return mesh;
}

TEST_F(MeshFileTest, OpenMeshReadsWrittenFiles) {
  for (const Format format : {Format::obj, Format::ply, Format::off}) {
    const fs::path file = path("ours" + extension_of(format));
    write_triangles(file, format, tetrahedron());
    OpenMeshTriangles mesh;
    ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, file.string()));
    EXPECT_EQ(from_openmesh(mesh), with_smallest_first(tetrahedron())) << file;
  }
  write_triangles(path("ours.stl"), Format::stl, tetrahedron());
  OpenMeshTriangles welded;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(welded, path("ours.stl").string()));
  EXPECT_EQ(welded.n_vertices(), 4U);
  EXPECT_EQ(welded.n_faces(), 4U);
}

TEST_F(MeshFileTest, FilesOfOpenMeshAreRead) {
  const TriangleMesh mesh = tetrahedron();
  OpenMeshTriangles theirs;
  for (const Vec3f& p : mesh.positions) theirs.add_vertex({p.x, p.y, p.z});
  for (const auto& [a, b, c] : mesh.triangles)
    theirs.add_face(theirs.vertex_handle(a), theirs.vertex_handle(b), theirs.vertex_handle(c));
  theirs.request_vertex_normals();
  theirs.request_face_normals();  // update_normals needs them
  theirs.update_normals();
  using Options = OpenMesh::IO::Options;
  const std::vector<std::pair<Format, OpenMesh::IO::Options>> kinds{
      {Format::obj, Options::Default},
      {Format::obj, Options::VertexNormal},
      {Format::off, Options::Default},
      {Format::off, Options::VertexNormal},
      {Format::ply, Options::Default},
      {Format::ply, Options::VertexNormal},
      {Format::ply, Options::Binary},
      {Format::ply, Options::Binary | Options::VertexNormal},
      {Format::ply, Options::Binary | Options::MSB},
      {Format::stl, Options::Default},
      {Format::stl, Options::Binary},
  };
  for (const auto& [format, options] : kinds) {
    const fs::path file = path("theirs" + extension_of(format));
    ASSERT_TRUE(OpenMesh::IO::write_mesh(theirs, file.string(), options));
    TriangleMesh found = read_triangles(file, format);
    EXPECT_EQ(found.attributes.size(), format != Format::off && options.vertex_has_normal() ? 1U : 0U);
    found.attributes.clear();
    EXPECT_EQ(with_smallest_first(format == Format::stl ? welded(found, mesh.positions) : found),
              with_smallest_first(mesh))
        << extension_of(format) << " with options " << static_cast<unsigned>(options);
  }
}

}  // namespace
}  // namespace papilio::client
