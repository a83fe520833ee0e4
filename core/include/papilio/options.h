#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "papilio/view.h"

namespace papilio {

/// Mesh that each level refines.
enum class Scheme {
  /// Hierarchy of the uniform subdivision, built only where edges are split; the default. Transition triangles
  /// close the result and are never refined. Every vertex is bit-identical to a vertex of the uniform result.
  red_green,
  /// Mesh of the level before, transition triangles included, as in the paper. Angles halve along the border of the
  /// refined region, and vertices depend on the history of the refinement.
  in_place,
};

/// Spread of marks, section 3.1.2 of the paper.
enum class Growth {
  off = 0,
  faces = 1,     ///< to the other edges of both faces at a marked edge
  vertices = 2,  ///< to all edges at both ends of a marked edge
};

/// Rule against overshoot at sharp edges.
enum class Tension {
  soft,   ///< reduced weight of hinges sharper than 60 degrees, and none of 90 degrees and more
  off,    ///< plain Modified Butterfly scheme
  sharp,  ///< soft, and sharp edges themselves follow the four-point rule along their feature
};

/// Kind of surface. The published rules round every edge that is not a crease: flat sides bulge, and slivers fold over.
/// The shape rules (mesh/shape.h, rules/shape_rules.h) prevent this. They require tension: without it, every shape is
/// `plain`.
enum class Shape {
  automatic,   ///< by component: mechanical if its faces lie flat or meet sharply, or its area is flat; else organic
  organic,     ///< round everywhere; flat parts stay flat, and faces rarely turn over
  mechanical,  ///< also keeps edges over 31 degrees and the outlines of broad flats as creases, and their corners
  plain,       ///< scheme and tension as published, without shape rules
};

/// Memory that a caller uses for each level it receives, beside the level itself; for example, to encode it.
struct OutputBytes {
  uint64_t face = 0;   ///< bytes a face
  uint64_t point = 0;  ///< bytes a point, or a vertex of a mesh without attributes
};

/// Parameters of a refinement. The defaults refine uniformly, two levels.
struct Options {
  int levels = 2;  ///< 0..10; a uniform level multiplies the faces by four
  Scheme scheme = Scheme::red_green;
  /// Lower bounds of the dot product of the unit normals at an edge, one a level, -1..1; an edge below its bound is
  /// split. The last repeats; empty: all edges are split. Higher is finer. In the red-green scheme, the first applies
  /// to edges of the coarse mesh, the next to edges of the uniform level 1, and so on.
  std::vector<double> flatness{};
  Growth growth = Growth::faces;    ///< spread of the edges that `flatness` selects; more is smoother and larger
  std::optional<View> view{};       ///< view to refine for: only what it shows is refined
  Tension tension = Tension::soft;  ///< rule against overshoot at sharp edges
  Shape shape = Shape::automatic;   ///< kind of surface, which decides what is kept sharp or flat
  double w = 0;                     ///< -1/16..1/8, the ten-point rule's free parameter; 0 is the eight-point rule
  double crease_angle = 180;        ///< degrees, 0..180: edges whose faces' normals differ by more are creases;
                                    ///< 180: creases are found by `shape` and marked by smoothing groups
  /// Lower bound of the surface's move at a split edge, a share (0..1) of the diagonal of the coarse mesh's bounding
  /// box. 0: other criteria decide alone. In the red-green scheme, with neither view nor flatness, it is also the upper
  /// bound of the distance between the result and the uniform result: further edges are split until it holds.
  double tolerance = 0;
  /// Upper bound of the faces of the result: edges with the largest error are split first. 0: no bound.
  uint64_t max_faces = 0;
  bool simplify_hidden = false;  ///< whether to simplify what the view hides, in the result; requires a view
  uint64_t face_limit =
      16'000'000;  ///< upper bound of the faces of a level; beyond it, it is refused before it is made
  /// Upper bound of the bytes that a level takes while it is made, or together with `output`; beyond it, the level is
  /// refused before it is made. 0: no bound.
  uint64_t memory_limit = 0;
  OutputBytes output{};
  /// Whether to stop with `StopReason::limits` before a level that would exceed `face_limit` or `memory_limit`, instead
  /// of refusing it. Not for uniform refinement.
  bool stop_at_limits = false;
  bool edges = true;          ///< whether to number the result's edges (mesh.h); not needed to write its faces
  bool measure_error = true;  ///< whether to measure the deviation left (`Result::error`); else both errors are 0
};

/// Throws `Error` bad_option, with the name of the field, if an option is outside its range.
void check_options(const Options& options);

}  // namespace papilio
