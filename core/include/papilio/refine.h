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

/// Callbacks and threads of a refinement. Both functions may be empty; both are called on the calling thread.
struct Hooks {
  std::function<void(const Level&)> on_level{};  ///< called with each level, the coarse one first; may throw to stop
  std::function<bool()> cancelled{};             ///< polled between steps; true stops with `Fault::cancelled`
  int threads = 1;  ///< upper bound of the threads at work; the result is bit-identical for any number
};

/// Throws `Error` result_too_large, before any work is done, if the result is bound to exceed `face_limit`,
/// `memory_limit` or `max_faces`; bad_option if the scheme cannot refine a mesh with detail.
void check_room(const Mesh& coarse, const Options& options);

/// Returns the shapes that `refine` finds on the mesh under these options.
[[nodiscard]] ShapeReport shape_of(Mesh coarse, const Options& options = {});

/// Returns whether a prepared mesh makes this request cheaper: refinement is neither uniform nor in place.
[[nodiscard]] bool uses_hierarchy(const Options& options);

/// Refines the mesh. Vertices of `coarse` keep their numbers, and their positions to the bit. `simplify_hidden` may
/// drop hidden vertices, which lowers the numbers of later ones. Re-entrant and stateless. Throws `Error`: bad_option,
/// result_too_large (with the number), cancelled, out_of_memory.
[[nodiscard]] Result refine(Mesh coarse, const Options& options, const Hooks& hooks = {});

/// Refines a prepared mesh, with a result bit-identical to refine() of its coarse mesh. Uses the levels that earlier
/// calls kept, and keeps new ones. Thread-safe. Throws `Error` as refine(), and bad_option if the mesh was prepared for
/// other rules.
[[nodiscard]] Result refine(const PreparedMesh& coarse, const Options& options, const Hooks& hooks = {});

}  // namespace papilio
