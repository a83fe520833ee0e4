#include "hierarchy/near_pieces.h"

#include <utility>

namespace papilio {

void NearPieces::go_to(const LevelFace& leaf) {
  leaf_ = leaf;
  prisms_.clear();
  has_beside_ = false;
}

PointNear NearPieces::near(Vec3d point, double enough) {
  PointNear found = beside(point, enough);
  if (found.triangle != none) return found;
  TriangleCorners nearest{};
  found.squared = result_->squared_distance_from(leaf_, point, enough, &nearest);
  found.triangle = prisms_.add(nearest);
  return found;
}

PointNear NearPieces::beside(Vec3d point, double enough) {
  if (prisms_.size() == 0) add_prisms(leaf_);
  const uint32_t known = prisms_.size();
  const PointNear found = prisms_.find(point, enough);
  if (found.triangle != none || std::exchange(has_beside_, true)) return found;
  for (uint32_t side = 0; side < 3; ++side) {
    result_->find_beside(leaf_, side, beside_);
    for (const LevelFace& beside : beside_) add_prisms(beside);
  }
  return prisms_.find(point, enough, known);
}

void NearPieces::add_prisms(const LevelFace& leaf) {
  result_->find_pieces(leaf, pieces_);
  for (const TriangleCorners& piece : pieces_) prisms_.add(piece);
}

}  // namespace papilio
