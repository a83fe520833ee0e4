#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "papilio/view.h"

namespace papilio {

/// What a level works on.
enum class Scheme {
  /// The hierarchy of the uniform subdivision, built only where it is wanted; transition triangles close the mesh in
  /// the result and are never refined. Every vertex is bit for bit that of the uniform result. Ours, the default.
  red_green,
  /// The mesh that the level before left, transition triangles included: the paper's. Angles halve along the border of
  /// what is refined, and vertices depend on the refinement's history.
  in_place,
};

/// How far marks spread, the paper's section 3.1.2.
enum class Growth {
  off = 0,
  faces = 1,     ///< to the other edges of the two faces at a marked edge
  vertices = 2,  ///< to all edges at the two ends of a marked edge
};

/// What keeps the surface from overshooting at sharp edges.
enum class Tension {
  soft,   ///< hinges sharper than 60 degrees count less, those of 90 and more not at all
  off,    ///< the plain Modified Butterfly scheme
  sharp,  ///< soft, and sharp edges themselves follow the four-point rule along their feature
};

/// What the mesh is taken for. The published rules round everything that no crease holds: flat sides bulge, slivers
/// fold over. The shape rules (mesh/shape.h, rules/shape_rules.h) keep from that, and need tension: without it all is
/// `plain`.
enum class Shape {
  automatic,   ///< each component by its angles: mechanical if its faces lie flat or meet sharply, else organic
  organic,     ///< round everywhere; flat parts stay flat, and faces rarely turn over
  mechanical,  ///< also keeps edges over 31 degrees and the outlines of broad flats as creases, and their corners
  plain,       ///< the scheme and tension as published, and nothing else
};

/// Memory that a caller needs for a level that it is given, beside the level's own: to encode it, say.
struct OutputBytes {
  uint64_t face = 0;   ///< bytes a face
  uint64_t point = 0;  ///< bytes a point of the attributes, or a vertex where there are none
};

/// What to do. The defaults refine uniformly, two levels.
struct Options {
  int levels = 2;  ///< 0..10; a uniform level multiplies the faces by four
  Scheme scheme = Scheme::red_green;
  /// Edges at which the unit normals' product is below the threshold are targets. One threshold a level,
  /// -1..1, the last repeats; empty: all edges. Higher is finer. In the red-green scheme the first judges the
  /// edges of the coarse mesh, the next the edges that come of splitting these, and so on.
  std::vector<double> flatness{};
  Growth growth = Growth::faces;    ///< how far targets spread, after flatness; more is smoother and larger
  std::optional<View> view{};       ///< when set, only what this view shows is refined
  Tension tension = Tension::soft;  ///< what keeps the surface from overshooting at sharp edges
  Shape shape = Shape::automatic;   ///< what the mesh is taken for, and so what of it is kept
  double w = 0;                     ///< -1/16..1/8, the ten-point rule's free parameter; 0 is the eight-point rule
  double crease_angle = 180;        ///< degrees, 0..180: edges whose faces' normals differ by more are kept sharp;
                                    ///< 180: those that `shape` finds and smoothing groups mark
  /// Edges are split only where the surface would move by at least this share (0..1) of the coarse mesh's bounding
  /// box's diagonal; 0: wherever the other criteria say. In the red-green scheme, with neither view nor flatness,
  /// further ones are split until the result and the uniform one of the same levels are nowhere further apart than
  /// that.
  double tolerance = 0;
  /// The result never has more faces; the edges with the largest error are split first. 0: as many as it takes.
  uint64_t max_faces = 0;
  bool simplify_hidden = false;      ///< simplifies what the view does not show, in the result; needs a view
  uint64_t face_limit = 16'000'000;  ///< a level that would have more faces is refused before it is made
  /// A level that would take more bytes than this, while it is made or together with `output`, is refused before it is
  /// made; 0: no limit.
  uint64_t memory_limit = 0;
  OutputBytes output{};
  /// Ends the refinement before a level that would pass `face_limit` or `memory_limit`, with `StopReason::limits`, in
  /// place of refusing it. Not for uniform refinement.
  bool stop_at_limits = false;
  bool edges = true;          ///< number the result's edges (mesh.h); whoever only writes its faces out does without
  bool measure_error = true;  ///< find the deviation left (`Result::error`); without it both errors are 0
};

/// Throws `Error` bad_option, naming the field, when an option is outside its range.
void check_options(const Options& options);

}  // namespace papilio
