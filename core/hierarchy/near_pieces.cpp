#include "hierarchy/near_pieces.h"

#include <limits>

namespace papilio {

void NearPieces::go_to(const LevelFace& leaf) {
  leaf_ = leaf;
  prisms_.clear();
  has_beside_ = false;
}

PointNear NearPieces::near(Vec3d point, double enough) {
  PointNear found = beside(point, enough);
  if (found.piece != none) return found;
  TriangleCorners nearest{};
  found.squared = result_->squared_distance_from(leaf_, point, enough, &nearest);
  found.piece = static_cast<uint32_t>(prisms_.size());
  prisms_.emplace_back(nearest);
  return found;
}

PointNear NearPieces::beside(Vec3d point, double enough) {
  if (prisms_.empty()) add_prisms(leaf_);
  PointNear found{point, std::numeric_limits<double>::infinity()};
  for (uint32_t i = 0;; ++i) {
    if (i == prisms_.size() && !has_beside_) {
      has_beside_ = true;
      for (uint32_t side = 0; side < 3; ++side) {
        result_->find_beside(leaf_, side, beside_);
        for (const LevelFace& beside : beside_) add_prisms(beside);
      }
    }
    if (i == prisms_.size()) return found;
    if (!prisms_[i].is_within(point, enough, found.squared)) continue;
    found.piece = i;
    return found;
  }
}

void NearPieces::add_prisms(const LevelFace& leaf) {
  result_->find_pieces(leaf, pieces_);
  for (const TriangleCorners& piece : pieces_) prisms_.emplace_back(piece);
}

}  // namespace papilio
