#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// One level as it is made; valid during the callback only.
struct Level {
  int level;         ///< 0 is the coarse mesh; levels that change nothing, before one that does, are left out
  const Mesh& mesh;  ///< with or without edges, where `Options::edges` is off
  bool last;         ///< no further level will come
};

enum class StopReason {
  converged,  ///< no target edge was left (in place: nor does a later level have a higher flatness threshold)
  levels,     ///< all levels asked for were made
  budget,     ///< `max_faces` kept something out
  limits,     ///< a further level would have passed a limit (`Options::stop_at_limits`)
};

/// What the mesh was taken for (`Options::shape`).
struct ShapeReport {
  uint32_t components = 0;  ///< connected by edges; 0 where no shape rules hold
  uint32_t mechanical = 0;  ///< of these
  uint32_t creases = 0;     ///< edges of the coarse mesh
  uint32_t marked = 0;      ///< creases that smoothing groups mark (`Attribute::is_smoothing_group`)

  friend bool operator==(const ShapeReport&, const ShapeReport&) = default;
};

struct Result {
  Mesh mesh;       ///< with edges if `Options::edges`
  int levels = 0;  ///< the last level that changed the mesh
  StopReason stop_reason = StopReason::levels;
  /// The largest deviation left: the distance by which the surface would still move at an edge that was not split, as a
  /// share of the coarse mesh's diagonal. Where there is a view, of what it shows. For edges of the last level, which
  /// are not tried, a quarter of the deviation at the edges they come from: what a smooth surface does; nothing where
  /// that level is the last one of the mesh's detail. In the
  /// red-green scheme with a tolerance or budget, and neither view nor flatness, it is also no less than the distance
  /// between the result and the uniform one of the same levels, from both sides. 0 without `Options::measure_error`.
  double error = 0;
  double error_pixels = 0;  ///< the same in pixels of the view; 0 without one
  ShapeReport shape;
};

}  // namespace papilio
