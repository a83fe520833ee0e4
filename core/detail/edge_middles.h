#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Face of a collapse sequence that matches a base's face, and the corner that matches the first one.
struct FaceMatch {
  uint32_t face, turn;
};

/// Places of the middles of edges, level by level, on the faces of the base that contain them.
class EdgeMiddles {
 public:
  /// Starts at the base, with its `faces` [F], which must outlive this.
  explicit EdgeMiddles(std::span<const FaceMatch> faces);

  /// Returns [E] the middles of a level's edges, in the faces of their half-edges. The middle of an edge with one face
  /// is moved towards the face's apex by the share `inward`.
  [[nodiscard]] std::vector<SurfacePlace> of(const Topology& level, double inward = 0) const;
  /// Advances to the next level.
  void next();

 private:
  std::span<const FaceMatch> faces_;
  std::vector<std::array<Vec3d, 3>> weights_;  // [F of the level] weights of the corners in the base's face
  uint32_t level_ = 0;
};

}  // namespace papilio
