#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "error.h"
#include "flatness.h"
#include "mesh.h"
#include "tension.h"
#include "view.h"

// Refinement of a coarse triangle mesh by selective subdivision: Dong, Li, Kuo, "Refinement of 3D Meshes by
// Selective Subdivision". This header is all that most callers need.

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

/// What to do. The defaults refine uniformly, two levels.
struct Options {
  int levels = 2;  ///< 0..10; a uniform level multiplies the faces by four
  Scheme scheme = Scheme::red_green;
  /// Edges at which the unit normals' product is below the threshold are targets. One threshold a level,
  /// -1..1, the last repeats; empty: all edges. Higher is finer.
  std::vector<double> flatness{};
  Growth growth = Growth::faces;    ///< how far targets spread, after flatness; more is smoother and larger
  std::optional<View> view{};       ///< when set, only what this view shows is refined
  Tension tension = Tension::soft;  ///< what keeps the surface from overshooting at sharp edges
  double w = 0;                     ///< -1/16..1/8, the ten-point rule's free parameter; 0 is the eight-point rule
  double crease_angle = 180;        ///< degrees, 0..180: edges whose faces' normals differ by more are kept sharp
  /// Edges are split only where the surface would move by at least this share (0..1) of the coarse mesh's bounding
  /// box's diagonal; 0: wherever the other criteria say. See `deviation.h`.
  double tolerance = 0;
  /// The result never has more faces; the edges with the largest error are split first. 0: as many as it takes.
  uint64_t max_faces = 0;
  bool simplify_hidden = false;      ///< simplifies what the view does not show, in the result; needs a view
  uint64_t face_limit = 16'000'000;  ///< a level that would have more faces is refused before it is made
  /// A level whose arrays would take more bytes than this is refused before it is made; 0: no limit.
  uint64_t memory_limit = 0;
};

/// One level as it is made; valid during the callback only.
struct Level {
  int level;  ///< 0 is the coarse mesh; a level without targets, before one with a higher threshold, is left out
  const Mesh& mesh;
  bool last;  ///< no further level will come
};

/// How the caller takes part. Both may be empty; both are called on the calling thread.
struct Hooks {
  std::function<void(const Level&)> on_level{};  ///< after each level, the coarse one first; may throw to stop
  std::function<bool()> cancelled{};             ///< asked between steps; true stops with `Fault::cancelled`
};

enum class StopReason {
  converged,  ///< no target edge was left, and no later level has a higher threshold
  levels,     ///< all levels asked for were made
  budget,     ///< `max_faces` kept something out
};

struct Result {
  Mesh mesh;
  int levels = 0;  ///< the last level that changed the mesh
  StopReason stop_reason = StopReason::levels;
  /// The largest deviation left: the distance by which the surface would still move at an edge that was not split, as a
  /// share of the coarse mesh's diagonal. Where there is a view, of what it shows. For edges of the last level, which
  /// are not tried, a quarter of the deviation at the edges they come from: what a smooth surface does.
  double error = 0;
  double error_pixels = 0;  ///< the same in pixels of the view; 0 without one
};

/// Throws `Error` bad_option, naming the field, when an option is outside its range.
void check_options(const Options& options);

/// Throws `Error` result_too_large when a uniform refinement is bound to pass `face_limit`: before any work
/// is done.
void check_room(uint64_t faces, const Options& options);

/// Refines the mesh. Vertices of `coarse` keep their numbers and their positions to the bit. Re-entrant; no
/// state is kept. Throws `Error`: bad_option, result_too_large (with the number), cancelled, out_of_memory.
[[nodiscard]] Result refine(Mesh coarse, const Options& options, const Hooks& hooks = {});

}  // namespace papilio
