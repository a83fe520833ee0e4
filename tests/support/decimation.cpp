#include "tests/support/decimation.h"

#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace papilio::test {
namespace {

/// Throws unless every face has three different vertices of `mesh`, every coordinate is finite, and no edge
/// has more than two faces or two that disagree on its direction.
void check_faces(const DecimationMesh& mesh, const std::vector<DecimationTriangle>& triangles) {
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

/// Throws if a vertex has more than one fan of faces.
void check_vertices(const DecimationMesh& mesh) {
  for (const auto vertex : mesh.vertices()) {
    if (!mesh.is_manifold(vertex)) {
      throw std::runtime_error("vertex " + std::to_string(vertex.idx()) + " joins two parts of the surface");
    }
  }
}

bool is_closed(const DecimationMesh& mesh) {
  return std::none_of(mesh.halfedges_begin(), mesh.halfedges_end(),
                      [&mesh](OpenMesh::HalfedgeHandle half_edge) { return mesh.is_boundary(half_edge); });
}

}  // namespace

std::vector<DecimationTriangle> triangles_of(const DecimationMesh& mesh) {
  std::vector<DecimationTriangle> triangles;
  for (const auto face : mesh.faces()) {
    DecimationTriangle triangle{};
    std::ranges::transform(face.vertices().to_vector(), triangle.begin(), [](const auto& v) { return v.idx(); });
    triangles.push_back(triangle);
  }
  return triangles;
}

void add_faces(DecimationMesh& mesh, const std::vector<DecimationTriangle>& triangles) {
  check_faces(mesh, triangles);
  for (const auto& [a, b, c] : triangles) {
    using Vertex = OpenMesh::VertexHandle;
    if (!mesh.add_face(Vertex(a), Vertex(b), Vertex(c)).is_valid()) {
      throw std::runtime_error("the surface is not manifold");
    }
  }
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  check_vertices(mesh);
}

void decimate(DecimationMesh& mesh, size_t faces) {
  const bool closed = is_closed(mesh);
  mesh.update_face_normals();
  OpenMesh::Decimater::DecimaterT<DecimationMesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<DecimationMesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<DecimationMesh>::Handle flipping;
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

}  // namespace papilio::test
