#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"

namespace papilio {

/// Point of a surface that is nearest to a point.
struct Nearest {
  double squared_distance = std::numeric_limits<double>::infinity();
  uint32_t face = none;
  Vec3d point{};
};

/// Bounding volume hierarchy of a surface's triangles, for nearest points.
class SurfaceTree {
 public:
  /// Builds the tree of at least one triangle. O(F log F).
  explicit SurfaceTree(TriangleMesh surface);

  /// Returns the nearest point; `face` is `none` beyond `reach`. If `normal` is not zero, only faces whose normal is
  /// within 75 degrees of it count.
  [[nodiscard]] Nearest nearest(Vec3d point, double reach = std::numeric_limits<double>::infinity(),
                                Vec3d normal = {}) const;

  /// Returns the unit normal of a face; zero if it has no area.
  [[nodiscard]] Vec3d unit_normal(uint32_t face) const { return to_double(normals_[face]); }
  [[nodiscard]] const TriangleMesh& surface() const { return surface_; }
  [[nodiscard]] TriangleCorners corners(uint32_t face) const;

 private:
  struct Node {
    Vec3f min, max;
    uint32_t first;  ///< first of its triangles; or if `count` is 0, the pair of its children
    uint32_t count;
  };
  /// Children of a node: looked at together, so in one cache line.
  struct alignas(64) Pair {
    std::array<Node, 2> children;
  };
  /// Triangle of a leaf.
  struct Leaf {
    Vec3f a, b, c;
    uint32_t face;
  };
  struct Centre {
    Vec3f at;
    uint32_t face;
  };
  [[nodiscard]] Node build(std::span<Centre> centres);

  TriangleMesh surface_;
  Node root_{};
  std::vector<Pair> pairs_;
  std::vector<Leaf> leaves_;    // [F] by leaf
  std::vector<Vec3f> normals_;  // [F]
};

}  // namespace papilio
