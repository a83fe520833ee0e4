#include "detail/edge_middles.h"

namespace papilio {

EdgeMiddles::EdgeMiddles(std::span<const FaceMatch> faces)
    : faces_(faces), weights_(faces.size(), {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {}

std::vector<SurfacePlace> EdgeMiddles::of(const Topology& level, double inward) const {
  std::vector<SurfacePlace> places;
  places.reserve(level.edge_count());
  for (const uint32_t h : level.half_edge) {
    const auto& corner = weights_[h / 3];
    Vec3d middle = 0.5 * (corner[h % 3] + corner[(h + 1) % 3]);
    if (level.twin[h] == none) middle = middle + inward * (corner[(h + 2) % 3] - middle);
    const FaceMatch& match = faces_[(h / 3) >> (2 * level_)];
    const std::array<double, 3> in_base{middle.x, middle.y, middle.z};
    std::array<double, 3> turned{};
    for (uint32_t i = 0; i < 3; ++i) turned[(i + match.turn) % 3] = in_base[i];
    places.push_back({match.face, {turned[0], turned[1], turned[2]}});
  }
  return places;
}

void EdgeMiddles::next() {
  std::vector<std::array<Vec3d, 3>> below;
  below.reserve(4 * weights_.size());
  for (const auto& [a, b, c] : weights_) {
    const Vec3d ab = 0.5 * (a + b);
    const Vec3d bc = 0.5 * (b + c);
    const Vec3d ca = 0.5 * (c + a);
    below.insert(below.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  weights_ = std::move(below);
  ++level_;
}

}  // namespace papilio
