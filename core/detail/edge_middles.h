#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// A face of a sequence of collapses, and which of its corners the first one of a base's face is.
struct FaceMatch {
  uint32_t face, turn;
};

/// Places of the middles of edges, level by level, on the faces of the base that they come from.
class EdgeMiddles {
 public:
  /// `faces` [F] of the base; must outlive this.
  explicit EdgeMiddles(std::span<const FaceMatch> faces);

  /// Returns the middles of a level's edges [E], in the faces of their half-edges. Those of edges with one face are
  /// moved towards the face's other corner by this share of the way.
  [[nodiscard]] std::vector<SurfacePlace> of(const Topology& level, double inward = 0) const;
  /// Goes on to the next level.
  void next();

 private:
  std::span<const FaceMatch> faces_;
  std::vector<std::array<Vec3d, 3>> weights_;  // [F of the level] of the corners, in the base's face above
  uint32_t level_ = 0;
};

}  // namespace papilio
