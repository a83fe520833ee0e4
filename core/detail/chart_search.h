#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/original_surface.h"
#include "papilio/mesh.h"

namespace papilio {

/// Finds the places of an original near points, within the chart where the search begins: no seam is crossed.
class ChartSearch {
 public:
  /// The original must have attributes, and outlive this.
  explicit ChartSearch(const OriginalSurface& original);

  struct Found {
    uint32_t face;
    std::array<double, 3> weights;  ///< of its corners
  };
  /// Looks from these faces on, the nearest first, for the face that is nearest to the point, until several in a row
  /// are no nearer. Returns its point nearest to the point.
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
  uint32_t search_ = 0;           // at hand
  std::vector<Candidate> queue_;  // heap
};

}  // namespace papilio
