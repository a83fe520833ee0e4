#pragma once

#include <cstdint>
#include <functional>

#include "error.h"
#include "mesh.h"
#include "options.h"
#include "prepared_mesh.h"

// Refinement of a coarse triangle mesh by selective subdivision: Dong, Li, Kuo, "Refinement of 3D Meshes by
// Selective Subdivision". This header is all that most callers need.

namespace papilio {

/// One level as it is made; valid during the callback only.
struct Level {
  int level;         ///< 0 is the coarse mesh; levels that change nothing, before one that does, are left out
  const Mesh& mesh;  ///< with or without edges, where `Options::edges` is off
  bool last;         ///< no further level will come
};

/// How the caller takes part. Both functions may be empty; both are called on the calling thread.
struct Hooks {
  std::function<void(const Level&)> on_level{};  ///< after each level, the coarse one first; may throw to stop
  std::function<bool()> cancelled{};             ///< asked between steps; true stops with `Fault::cancelled`
  int threads = 1;  ///< at most so many work on it at once; the result is the same to the bit
};

enum class StopReason {
  converged,  ///< no target edge was left (in place: nor does a later level have a higher flatness threshold)
  levels,     ///< all levels asked for were made
  budget,     ///< `max_faces` kept something out
  limits,     ///< a further level would have passed a limit (`Options::stop_at_limits`)
};

struct Result {
  Mesh mesh;       ///< with edges if `Options::edges`
  int levels = 0;  ///< the last level that changed the mesh
  StopReason stop_reason = StopReason::levels;
  /// The largest deviation left: the distance by which the surface would still move at an edge that was not split, as a
  /// share of the coarse mesh's diagonal. Where there is a view, of what it shows. For edges of the last level, which
  /// are not tried, a quarter of the deviation at the edges they come from: what a smooth surface does. 0 without
  /// `Options::measure_error`.
  double error = 0;
  double error_pixels = 0;  ///< the same in pixels of the view; 0 without one
};

/// Throws `Error` result_too_large when the result is bound to pass `face_limit`, `memory_limit` or `max_faces`: before
/// any work is done.
void check_room(const Mesh& coarse, const Options& options);

/// Whether a prepared mesh makes this request cheaper: it is neither uniform nor in place.
[[nodiscard]] bool uses_hierarchy(const Options& options);

/// Refines the mesh. Vertices of `coarse` keep their numbers and their positions to the bit; with `simplify_hidden`
/// hidden ones may be dropped, which moves the numbers of the others up. Re-entrant; no state is kept. Throws `Error`:
/// bad_option, result_too_large (with the number), cancelled, out_of_memory.
[[nodiscard]] Result refine(Mesh coarse, const Options& options, const Hooks& hooks = {});

/// The same, to the bit, for a mesh that is refined more than once: what earlier calls made of it is used, and what
/// this one makes is kept for later ones. May be called from several threads at once. Throws `Error` bad_option also
/// where the mesh was prepared for other rules.
[[nodiscard]] Result refine(const PreparedMesh& coarse, const Options& options, const Hooks& hooks = {});

}  // namespace papilio
