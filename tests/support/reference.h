#pragma once

#include <array>
#include <vector>

#include "papilio/refine.h"

// Simple reference implementation of refinement, to check the core. It computes whole levels of the uniform subdivision
// in double precision and finds neighbours in maps. It shares only data types with the core. Not covered: attributes,
// limits, `simplify_hidden`, level callbacks, faces that share all three vertices, faces without area.
//
// Read reference_surface.h (fans, curves, split patterns), reference_rules.h (new vertices), reference_criteria.h
// (which edges are split), then reference.cpp (the two schemes).

namespace papilio::reference {

struct Outcome {
  std::vector<std::array<Vec3d, 3>> triangles{};
  int levels = 0;
  StopReason stop_reason = StopReason::levels;
  double error = 0, error_pixels = 0;
  double pixels_per_unit = 0;  ///< largest at an edge whose error counts
  /// Smallest change of coordinates that may reverse a decision, as a share of the largest coordinate. The core must
  /// make equal decisions if it is well above the rounding of single precision.
  double margin = 0;
  /// Known difference of the core. A crease ends at a vertex of six faces or of several fans; a sliver lies across a
  /// shared edge; or, in place, lights shine on a shared edge.
  bool is_disputed = false;
};

/// Refines the mesh.
[[nodiscard]] Outcome refine(const Mesh& mesh, const Options& options);

}  // namespace papilio::reference
