#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/original_surface.h"
#include "papilio/mesh.h"

namespace papilio {

/// Search for the places of an original near points, within the chart of the start: it crosses no seam.
class ChartSearch {
 public:
  /// Marks the seams. The original must have attributes, and outlive this.
  explicit ChartSearch(const OriginalSurface& original);

  struct Found {
    uint32_t face;
    std::array<double, 3> weights;  ///< barycentric weights of its corners
  };
  /// Returns the place nearest to the point. Visits faces from `starts` on, the nearest first, until several in a row
  /// are no nearer.
  [[nodiscard]] Found nearest(std::span<const uint32_t> starts, Vec3d point);

 private:
  struct Candidate {
    double squared_distance;
    uint32_t face;
  };
  void push(uint32_t face, Vec3d point);

  const OriginalSurface& original_;
  std::vector<bool> is_seam_;     // [E]
  std::vector<uint32_t> seen_;    // [F] search that saw a face last
  uint32_t search_ = 0;           // number of the current search
  std::vector<Candidate> queue_;  // heap
};

}  // namespace papilio
