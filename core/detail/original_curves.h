#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "detail/sharp_curves.h"
#include "detail/surface_tree.h"
#include "papilio/mesh.h"

namespace papilio {

/// Boundaries and creases of an original, or its seams, as polylines.
class OriginalCurves {
 public:
  /// Takes boundaries and creases. The mesh must be manifold, with edges and corners.
  explicit OriginalCurves(const Mesh& mesh);
  /// Takes some edges. Polylines end at vertices whose role is not `CurveRole::inner`.
  OriginalCurves(const Mesh& mesh, std::span<const uint32_t> edges, const std::vector<CurveRole>& roles);

  [[nodiscard]] bool empty() const { return segments_.empty(); }
  /// Returns the nearest point of all curves; `face` is the number of its segment.
  [[nodiscard]] Nearest nearest(Vec3d point, double reach = std::numeric_limits<double>::infinity()) const;
  /// Follows the curve from a segment to its intersection with the plane through `point` across `direction`. Stops at
  /// its ends and at a distance of `reach` from `start`.
  [[nodiscard]] std::optional<Vec3d> meet(uint32_t segment, Vec3d start, Vec3d point, Vec3d direction,
                                          double reach) const;

 private:
  struct Segment {
    std::array<uint32_t, 2> vertex;
    std::array<uint32_t, 2> beyond{none, none};  ///< segment that continues beyond each vertex
  };
  [[nodiscard]] Vec3d place(uint32_t vertex) const { return to_double(positions_[vertex]); }

  const Buffer<Vec3f>& positions_;
  std::vector<Segment> segments_;
  std::optional<SurfaceTree> tree_;  // tree of faces without area, one a segment
};

}  // namespace papilio
