#pragma once

#include <array>
#include <cstdint>

namespace papilio {

/// Upper bound of the magnitude of a residual, in steps.
inline constexpr int32_t largest_residual = (1 << 20) - 1;

/// Upper bound of the number of other edges of an edge's two faces.
inline constexpr uint32_t most_neighbours = 4;

/// Coding context of a residual. What is not coded yet counts as 0.
struct ResidualContext {
  uint32_t level = 0;                                 ///< number; 1 is the first below the base
  std::array<int32_t, most_neighbours> neighbours{};  ///< residuals of the other edges of its two faces
  uint32_t known = 0;                                 ///< number of coded neighbours
  uint32_t free_neighbours = 0;                       ///< number of coded neighbours with tangential parts
  uint32_t parents = 0;                               ///< mean magnitude round the edge on the level before, in eighths
  uint32_t turn = 0;    ///< distance of the prediction from the middle of the edge, in eighths of steps
  int32_t ends = 0;     ///< sum of the residuals of the ends that the level before made
  int32_t sibling = 0;  ///< residual of the other half of the edge that the level before split
  int32_t beyond = 0;   ///< sum of the residuals of the edges of the faces that lie across the neighbours
  bool has_sibling = false, has_beyond = false;  ///< whether these are coded, one at least
  double bow = 0;  ///< distance of the prediction from the middle of the edge along the normal, in steps
};

/// Coding context of the residual of an edge on a curve.
struct CurveContext {
  uint32_t level = 0;                       ///< number; 1 is the first below the base
  uint32_t parent = 0;                      ///< magnitude at the end that the level before made
  bool has_sibling = false;                 ///< whether the other half of the parent edge is coded
  int32_t sibling = 0, sibling_across = 0;  ///< parts of the other half's residual
};

}  // namespace papilio
