#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"
#include "papilio/vec3.h"

namespace papilio::client {

/// Of length one; nothing for a degenerate triangle.
[[nodiscard]] std::optional<Vec3d> unit_normal(const TriangleCorners& triangle);

/// Finds the point of a surface that is nearest to a given one, through a tree of boxes (median splits, so
/// that its depth is the logarithm of the number of triangles). Own, because Debian has no libigl, and CGAL's
/// or Embree's tree would bring Boost, GMP and MPFR, or TBB and single precision, for these hundred lines.
/// Threads may share it.
class SurfaceDistance {
 public:
  /// At least one triangle; all corners finite.
  explicit SurfaceDistance(std::span<const TriangleCorners> triangles);

  struct Nearest {
    double distance;  ///< in the mesh's unit
    /// Cosine of the angle between `normal` and the nearest face's; of faces equally near, such as the two at
    /// an edge, that of the one that agrees best. Nothing if no face that near has a normal.
    std::optional<double> cosine;
  };
  /// `normal` has length one.
  [[nodiscard]] Nearest nearest(Vec3d point, Vec3d normal) const;
  /// In the mesh's unit.
  [[nodiscard]] double distance(Vec3d point) const;

 private:
  struct Box {
    Vec3d low, high;
  };
  /// Two children, the first right after this node; or, if `count` is not 0, triangles from `first` on.
  struct Node {
    Box box;
    uint32_t first;  ///< the first triangle, or the second child
    uint32_t count;
  };

  void build(uint32_t begin, uint32_t end);
  [[nodiscard]] Box bounds(uint32_t begin, uint32_t end) const;
  [[nodiscard]] static double squared_distance_to_box(Vec3d point, const Box& box);
  /// Calls `visit` with each triangle whose box is at most `reach()` (squared) away, nearer boxes first.
  template <class Reach, class Visit>
  void walk(Vec3d point, const Reach& reach, const Visit& visit) const;

  std::vector<TriangleCorners> triangles_;  ///< in the order of the tree's leaves
  std::vector<Node> nodes_;
  double tie_ = 0;  ///< distances this close are equal but for rounding
};

}  // namespace papilio::client
