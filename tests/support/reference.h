#pragma once

#include <array>
#include <vector>

#include "papilio/refine.h"

// Reference implementation of refinement, slow and obvious, to check the core against. It computes whole levels of the
// uniform subdivision in double precision and finds neighbours in maps. It shares data types with the core, and no
// rule. Not covered: attributes, limits, `simplify_hidden`, levels reported on the way, faces that share all three
// vertices, faces without area.
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
  /// Smallest change of coordinates that may reverse a decision, as a share of the largest coordinate. Well above the
  /// rounding of single precision, the core must decide alike.
  double margin = 0;
  /// Known difference of the core. A crease ends at a vertex of six faces or of several fans; a sliver lies across a
  /// shared edge; or, in place, lights shine on a shared edge.
  bool is_disputed = false;
};

/// Refines the mesh.
[[nodiscard]] Outcome refine(const Mesh& mesh, const Options& options);

}  // namespace papilio::reference
