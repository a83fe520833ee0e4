#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"

namespace papilio {

/// The nearest of a surface's points to a point.
struct Nearest {
  double squared_distance = std::numeric_limits<double>::infinity();
  uint32_t face = none;
  Vec3d point{};
};

/// Tree of boxes over a surface's triangles, to find its nearest points.
class SurfaceTree {
 public:
  /// Of at least one triangle. O(F log F).
  explicit SurfaceTree(TriangleMesh surface);

  /// The nearest point; none (`face`) beyond `reach`. Where `normal` is not zero, only of faces whose normal is within
  /// 75 degrees of it.
  [[nodiscard]] Nearest nearest(Vec3d point, double reach = std::numeric_limits<double>::infinity(),
                                Vec3d normal = {}) const;

  /// Zero for a face without area.
  [[nodiscard]] Vec3d unit_normal(uint32_t face) const { return to_double(normals_[face]); }
  [[nodiscard]] const TriangleMesh& surface() const { return surface_; }
  [[nodiscard]] TriangleCorners corners(uint32_t face) const;

 private:
  struct Node {
    Vec3f min, max;
    uint32_t first;  ///< of its triangles; or, where `count` is 0, its left child, which the right one follows
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
