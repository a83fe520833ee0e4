#include "tests/support/streamed_detail.h"

#include "core/detail/detail_level.h"
#include "core/detail/residual_frames.h"
#include "core/detail/residuals.h"

namespace papilio::test {

DetailSource detail_of_residuals(const TriangleMesh& base, int levels, float first_step,
                                 const ResidualOfEdge& residual) {
  DetailSource source{{base, {}}, {}};
  Mesh mesh = build_mesh(base);
  Buffer<Vec3f> positions = std::move(mesh.positions);
  Buffer<int32_t> at_vertex(positions.size());
  const auto models = std::make_unique<ResidualModels>();
  DetailLevel level(std::move(mesh.topology));
  float step = first_step;
  for (int l = 0; l < levels; ++l, step /= 4) {
    const Topology& t = level.topology();
    const Buffer<Vec3f> normals = residual_normals(level, positions.data());
    Residuals residuals;
    residuals.step = step;
    residuals.across.resize(level.curve_edges().size());
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
      const uint32_t h = t.half_edge[e];
      residuals.along_normal.push_back(residual(l, e, 0.5F * (positions[t.origin[h]] + positions[t.tip(h)])));
    }
    level.predict(positions);
    source.levels.push_back({step, encode_residuals(level, residuals, at_vertex, positions, *models)});
    displace(level, normals, residuals, positions);
    at_vertex.insert(at_vertex.end(), residuals.along_normal.begin(), residuals.along_normal.end());
    level = level.next();
  }
  return source;
}

Mesh with_detail(const DetailSource& source) {
  Mesh mesh = build_mesh(source.base.triangles);
  mesh.attach_detail(stream_detail(source));
  return mesh;
}

}  // namespace papilio::test
