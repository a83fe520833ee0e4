#pragma once

#include <cstdint>
#include <limits>
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
    uint32_t first;  ///< first of its triangles; or if `count` is 0, its left child, followed by the right one
    uint32_t count;
  };
  void build(uint32_t node, uint32_t first, uint32_t last, const std::vector<Vec3f>& centres);
  [[nodiscard]] static double squared_distance_to(const Node& node, Vec3d p);

  TriangleMesh surface_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;  // triangles, leaf by leaf
  std::vector<Vec3f> normals_;   // [F]
};

}  // namespace papilio
