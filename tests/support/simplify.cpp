#include "tests/support/simplify.h"

#include "papilio/mesh.h"
#include "tests/support/decimation.h"

namespace papilio::test {

TriangleMesh simplify(const TriangleMesh& mesh, size_t faces) {
  const TriangleMesh welded = build_mesh(mesh).triangles();
  DecimationMesh decimated;
  for (Vec3f p : welded.positions) decimated.add_vertex({p.x, p.y, p.z});
  std::vector<DecimationTriangle> triangles;
  for (const Triangle& t : welded.triangles)
    triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  add_faces(decimated, triangles);
  decimate(decimated, faces);

  TriangleMesh out;
  for (const auto vertex : decimated.vertices()) {
    const auto& p = decimated.point(vertex);
    out.positions.push_back(to_float({p[0], p[1], p[2]}));
  }
  for (const DecimationTriangle& t : triangles_of(decimated))
    out.triangles.push_back({static_cast<uint32_t>(t[0]), static_cast<uint32_t>(t[1]), static_cast<uint32_t>(t[2])});
  return out;
}

}  // namespace papilio::test
