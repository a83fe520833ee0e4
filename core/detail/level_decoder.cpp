#include "detail/level_decoder.h"

#include <cmath>

#include "detail/base_attributes.h"
#include "detail/base_curves.h"
#include "detail/manifold_surface.h"
#include "detail/residual_frames.h"
#include "detail/residuals.h"
#include "detail/seams.h"
#include "papilio/error.h"

namespace papilio {
namespace {

void require_finite(const Buffer<Vec3f>& positions) {
  for (const Vec3f p : positions)
    if (!(std::abs(p.x) <= coordinate_limit && std::abs(p.y) <= coordinate_limit && std::abs(p.z) <= coordinate_limit))
      throw Error(Fault::not_finite, "Detail moves a vertex beyond the largest coordinate: it is damaged.");
}

}  // namespace

Mesh mesh_of_base(const DetailBase& base) {
  require_detail_attributes(base.triangles.attributes);
  Mesh mesh = build_mesh(base.triangles);
  require_whole_parts(mesh);
  require_manifold(mesh);
  decode_base_curves(base.curves, mesh.topology);
  return mesh;
}

LevelDecoder::LevelDecoder(const Mesh& base, bool with_values)
    : order_(base),
      needs_(base.topology.vertex_count),
      positions_(base.positions),
      at_vertex_(positions_.size()),
      level_(base.topology, seam_edges(base)) {
  if (with_values && has_values(base.attributes.attributes)) values_.emplace(base, seam_edges(base));
}

const Topology& LevelDecoder::topology() {
  if (is_split_) level_ = level_.next();
  is_split_ = false;
  return level_.topology();
}

void LevelDecoder::decode(const DetailStream& stream) {
  (void)topology();  // makes the level that is split
  const Buffer<Vec3f> normals = residual_normals(level_, positions_.data());
  level_.predict(positions_);
  const std::vector<DetailPiece> pieces = pieces_of(stream);
  const std::vector<uint8_t> is_decoded = needs_.next(order_, pieces);
  const EdgePieces edges = order_.edges(level_.topology(), level_.number(), static_cast<uint32_t>(pieces.size()));
  const Residuals residuals =
      decode_residuals({level_, edges, at_vertex_, positions_, normals},
                       piece_bytes(stream.bytes, pieces, &DetailPiece::bytes, is_decoded), stream.step, *models_);
  displace(level_, normals, residuals, positions_);
  require_finite(positions_);
  if (values_) {
    values_->predict(level_.topology(), positions_);
    values_->decode(edges.on_cut(level_.topology(), values_->level().topology()),
                    piece_bytes(stream.texcoords.bytes, pieces, &DetailPiece::texcoord_bytes, is_decoded),
                    stream.texcoords.step);
  }
  at_vertex_.insert(at_vertex_.end(), residuals.along_normal.begin(), residuals.along_normal.end());
  is_split_ = true;
}

Mesh LevelDecoder::take_mesh() {
  (void)topology();  // makes the finest level
  Mesh made{.topology = std::move(level_).take_topology(), .positions = std::move(positions_)};
  if (values_) made.attributes = values_->points();
  return made;
}

}  // namespace papilio
