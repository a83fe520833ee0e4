#include "tests/support/streamed_detail.h"

#include <algorithm>

#include "core/detail/detail_level.h"
#include "core/detail/residual_frames.h"
#include "core/detail/residuals.h"

namespace papilio::test {

DetailSource detail_of_residuals(const TriangleMesh& base, int levels, float first_step, const ResidualOfEdge& residual,
                                 const std::vector<uint32_t>& piece_counts) {
  DetailSource source{{base, {}}, {}};
  Mesh mesh = build_mesh(base);
  const PieceOrder order(mesh);
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
    const uint32_t count = piece_counts[std::min(static_cast<size_t>(l), piece_counts.size() - 1)];
    const EdgePieces pieces = order.edges(t, static_cast<uint32_t>(l), count);
    DetailStream& stream = source.levels.emplace_back();
    stream.step = step;
    for (const std::vector<uint8_t>& piece :
         encode_residuals({level, pieces, at_vertex, positions, normals}, residuals, *models)) {
      stream.bytes.insert(stream.bytes.end(), piece.begin(), piece.end());
      if (count > 1) stream.pieces.push_back({.bytes = static_cast<uint32_t>(piece.size())});
    }
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
