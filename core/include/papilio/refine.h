#pragma once

#include <functional>

#include "papilio/error.h"
#include "papilio/mesh.h"
#include "papilio/options.h"
#include "papilio/prepared_mesh.h"
#include "papilio/result.h"

// Refinement of a coarse triangle mesh by selective subdivision: Dong, Li, Kuo, "Refinement of 3D Meshes by
// Selective Subdivision". This header is all that most callers need.

namespace papilio {

/// How the caller takes part. Both functions may be empty; both are called on the calling thread.
struct Hooks {
  std::function<void(const Level&)> on_level{};  ///< after each level, the coarse one first; may throw to stop
  std::function<bool()> cancelled{};             ///< asked between steps; true stops with `Fault::cancelled`
  int threads = 1;  ///< at most so many work on it at once; the result is the same to the bit
};

/// Throws `Error` result_too_large when the result is bound to pass `face_limit`, `memory_limit` or `max_faces`: before
/// any work is done.
void check_room(const Mesh& coarse, const Options& options);

/// What `refine` takes the mesh for under these options.
[[nodiscard]] ShapeReport shape_of(Mesh coarse, const Options& options = {});

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
