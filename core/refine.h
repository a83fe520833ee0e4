#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "error.h"
#include "flatness.h"
#include "mesh.h"
#include "view.h"

// Refinement of a coarse triangle mesh by selective subdivision: Dong, Li, Kuo, "Refinement of 3D Meshes by
// Selective Subdivision". This header is all that most callers need.

namespace papilio {

/// What to do. The defaults refine uniformly, two levels.
struct Options {
  int levels = 2;  ///< 0..10; a uniform level multiplies the faces by four
  /// Edges at which the unit normals' product is below the threshold are targets. One threshold a level,
  /// -1..1, the last repeats; empty: all edges. Higher is finer.
  std::vector<double> flatness{};
  Growth growth = Growth::faces;     ///< how far targets spread, after flatness; more is smoother and larger
  std::optional<View> view{};        ///< when set, only what this view shows is refined
  double w = 0;                      ///< -1/16..1/8, the ten-point rule's free parameter; 0 is the eight-point rule
  uint64_t face_limit = 16'000'000;  ///< a level that would have more faces is refused before it is made
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
};

struct Result {
  Mesh mesh;
  int levels = 0;  ///< the last level that changed the mesh
  StopReason stop_reason = StopReason::levels;
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
