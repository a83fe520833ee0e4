#include "hierarchy/near_pieces.h"

#include <algorithm>

namespace papilio {

void NearPieces::go_to(const LevelFace& leaf) {
  leaf_ = leaf;
  pieces_.clear();
  prisms_.clear();
}

bool NearPieces::has_near(Vec3d point, double squared) {
  return std::ranges::any_of(prisms(), [&](const Prism& prism) { return prism.has_near(point, squared); });
}

TriangleCorners NearPieces::near(Vec3d point, double enough, double& squared) {
  squared = 0;
  for (const Prism& prism : prisms())
    if (prism.has_near(point, enough)) return prism.triangle();
  TriangleCorners piece{};
  squared = result_->squared_distance_from(leaf_, point, enough, &piece);
  return piece;
}

bool NearPieces::has_near_all(std::span<const Vec3d> points, double enough) {
  return std::ranges::any_of(pieces(),
                             [&](const TriangleCorners& piece) { return is_near_all(piece, points, enough); });
}

std::span<const TriangleCorners> NearPieces::pieces() {
  if (pieces_.empty()) result_->find_pieces(leaf_, pieces_);
  return pieces_;
}

std::span<const Prism> NearPieces::prisms() {
  if (prisms_.empty())
    for (const TriangleCorners& piece : pieces()) prisms_.emplace_back(piece);
  return prisms_;
}

bool is_near_all(const TriangleCorners& piece, std::span<const Vec3d> points, double enough) {
  return std::ranges::all_of(points, [&](Vec3d point) { return squared_distance(point, piece) <= enough; });
}

}  // namespace papilio
