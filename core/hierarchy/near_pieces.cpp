#include "hierarchy/near_pieces.h"

#include <limits>

namespace papilio {

void NearPieces::go_to(const LevelFace& leaf) {
  leaf_ = leaf;
  prisms_.clear();
}

PointNear NearPieces::near(Vec3d point, double enough) {
  PointNear found = above(point, enough);
  if (found.has_piece) return found;
  found.squared = result_->squared_distance_from(leaf_, point, enough, &found.piece);
  found.has_piece = true;
  return found;
}

PointNear NearPieces::above(Vec3d point, double enough) {
  if (prisms_.empty()) {
    add_prisms(leaf_);
    for (uint32_t side = 0; side < 3; ++side) {
      result_->find_beside(leaf_, side, beside_);
      for (const LevelFace& beside : beside_) add_prisms(beside);
    }
  }
  for (const Prism& prism : prisms_)
    if (const double squared = prism.squared_height(point); squared <= enough && prism.is_inside(point))
      return {point, squared, true, prism.triangle()};
  return {point, std::numeric_limits<double>::infinity()};
}

void NearPieces::add_prisms(const LevelFace& leaf) {
  result_->find_pieces(leaf, pieces_);
  for (const TriangleCorners& piece : pieces_) prisms_.emplace_back(piece);
}

bool is_near(const TriangleCorners& piece, const PointNear& point, double enough) {
  if (point.has_piece && point.squared <= enough && point.piece == piece) return true;
  return squared_distance(point.point, piece) <= enough;
}

}  // namespace papilio
