#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"
#include "papilio/vec3.h"

namespace papilio::client {

/// Returns the unit normal; nothing for a degenerate triangle.
[[nodiscard]] std::optional<Vec3d> unit_normal(const TriangleCorners& triangle);

/// Search for the point of a surface nearest to a given one, by a bounding volume hierarchy with median splits, of
/// logarithmic depth. Thread-safe. Own code, as Debian has no libigl, and the trees of CGAL or Embree depend on Boost,
/// GMP and MPFR, or on TBB and single precision.
class SurfaceDistance {
 public:
  /// Builds the tree of at least one triangle, with finite corners.
  explicit SurfaceDistance(std::span<const TriangleCorners> triangles);

  struct Nearest {
    double distance;  ///< distance in the mesh's unit
    /// Cosine of the angle between `normal` and the nearest face's normal. Of equally near faces, such as two at an
    /// edge, the one of best agreement counts. Nothing if none of them has a normal.
    std::optional<double> cosine;
  };
  /// Returns the distance to the nearest point, and the agreement with `normal`, of unit length.
  [[nodiscard]] Nearest nearest(Vec3d point, Vec3d normal) const;
  /// Returns the distance in the mesh's unit.
  [[nodiscard]] double distance(Vec3d point) const;

 private:
  struct Box {
    Vec3d low, high;
  };
  /// Node with two children, the first of which follows it; or, if `count` is not 0, with triangles from `first` on.
  struct Node {
    Box box;
    uint32_t first;  ///< first triangle, or second child
    uint32_t count;
  };

  void build(uint32_t begin, uint32_t end);
  [[nodiscard]] Box bounds(uint32_t begin, uint32_t end) const;
  [[nodiscard]] static double squared_distance_to_box(Vec3d point, const Box& box);
  /// Calls `visit` with each triangle whose box is at most `reach()` (squared) away, nearer boxes first.
  template <class Reach, class Visit>
  void walk(Vec3d point, const Reach& reach, const Visit& visit) const;

  std::vector<TriangleCorners> triangles_;  ///< triangles in the order of the tree's leaves
  std::vector<Node> nodes_;
  double tie_ = 0;  ///< bound of the difference of equal distances by rounding
};

}  // namespace papilio::client
