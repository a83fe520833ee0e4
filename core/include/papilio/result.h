#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// One level of a refinement; valid during the callback only.
struct Level {
  int level;         ///< number; 0 is the coarse mesh. Numbers of levels that change nothing are skipped
  const Mesh& mesh;  ///< mesh; its edges are unspecified without `Options::edges`
  bool last;         ///< whether no further level follows
};

/// Reason why a refinement ended. A scene has the largest of its meshes' reasons. The others say what kept it from a
/// requested error, if any is requested.
enum class StopReason {
  /// The requested errors (`tolerance`, `View::error_pixels`) are reached, as `Result::error` and `error_pixels` say.
  /// Or no edge was left to split (in place: nor does a later level have a higher flatness threshold).
  converged,
  levels,  ///< all requested levels were made
  budget,  ///< `max_faces` was reached
  limits,  ///< a further level would have exceeded a limit (`Options::stop_at_limits`)
};

/// Shapes found on the mesh (`Options::shape`).
struct ShapeReport {
  uint32_t components = 0;  ///< components connected by edges; 0 without shape rules
  uint32_t mechanical = 0;  ///< mechanical components
  uint32_t creases = 0;     ///< creases among the edges of the coarse mesh
  uint32_t marked = 0;      ///< creases that smoothing groups mark (`Attribute::is_smoothing_group`)

  friend bool operator==(const ShapeReport&, const ShapeReport&) = default;
};

struct Result {
  Mesh mesh;       ///< refined mesh, with edges if `Options::edges`
  int levels = 0;  ///< number of the last level that changed the mesh
  StopReason stop_reason = StopReason::levels;
  /// Largest deviation left, a share of the coarse mesh's diagonal: the distance by which the surface would still move
  /// at an edge that was not split. With a view, only edges that it shows count. 0 without `Options::measure_error`.
  ///
  /// Edges of the last level count with a quarter of the deviation of the edges they come from, as on a smooth surface;
  /// with nothing if that level is the last one of the mesh's detail. In the red-green scheme with a tolerance or
  /// budget, and neither view nor flatness, it is also an upper bound of the two-sided distance between the result and
  /// the uniform result of as many levels.
  double error = 0;
  double error_pixels = 0;  ///< largest deviation left in pixels of the view; 0 without a view
  ShapeReport shape;
};

}  // namespace papilio
