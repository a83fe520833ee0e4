#include "papilio/refine.h"

#include <string>

#include "base/memory_guard.h"
#include "criteria/selection.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/progress.h"
#include "mesh/connect.h"
#include "mesh/shape.h"
#include "schemes/in_place.h"
#include "schemes/red_green.h"
#include "schemes/uniform.h"
#include "simplify/simplify.h"

namespace papilio {
namespace {

/// Returns the levels or the mesh for a scheme, from a mesh with its creases marked, or from a prepared one.
Levels levels_of(Mesh&& mesh, const Options& options, const Progress& progress) {
  return {std::move(mesh), options, progress};
}
Levels levels_of(const PreparedMesh& prepared, const Options& options, const Progress& progress) {
  return {prepared, options, progress};
}
Mesh mesh_of(Mesh&& mesh) { return std::move(mesh); }
Mesh mesh_of(const PreparedMesh& prepared) { return prepared.coarse(); }

/// Throws `Error` bad_option for the in-place scheme and a mesh with detail, also where both schemes split alike:
/// whether a request is refused does not depend on its other options.
void check_scheme(const Mesh& coarse, const Options& options) {
  if (coarse.detail && options.scheme == Scheme::in_place)
    throw Error(
        Fault::bad_option,
        "The in-place scheme does not refine a packed model: it splits faces that the model's detail does not have. "
        "Use the red-green scheme.",
        "scheme");
}

template <class Coarse>
Result run_scheme(Coarse&& coarse, const Options& options, const Selection& selection, const Progress& progress) {
  if (selection.is_uniform() && options.levels > 0)
    return refine_uniformly(mesh_of(std::forward<Coarse>(coarse)), options, selection, progress);
  if (options.scheme == Scheme::in_place)
    return refine_in_place(mesh_of(std::forward<Coarse>(coarse)), options, selection, progress);
  return refine_red_green(levels_of(std::forward<Coarse>(coarse), options, progress), options, selection, progress);
}

/// Returns whether errors are requested, and the result has none larger.
bool reaches_targets(const Result& result, const Options& options) {
  const double pixels = options.view ? options.view->error_pixels : 0;
  if (!options.measure_error || (options.tolerance == 0 && pixels == 0)) return false;
  return (options.tolerance == 0 || result.error <= options.tolerance) &&
         (pixels == 0 || result.error_pixels <= pixels);
}

template <class Coarse>
Result run(Coarse&& coarse, double diagonal, const Options& options, const Hooks& hooks) {
  const Selection selection(options, diagonal);
  const Progress progress(options, hooks);
  Result result = run_scheme(std::forward<Coarse>(coarse), options, selection, progress);
  if (reaches_targets(result, options)) result.stop_reason = StopReason::converged;
  if (options.simplify_hidden) {
    progress.poll();
    result.mesh =
        simplify_hidden(std::move(result.mesh), *selection.camera(), default_hidden_error, [&] { progress.poll(); });
  }
  if (!options.edges) forget_edges(result.mesh.topology);
  result.mesh.detail.reset();  // it applies to the coarse mesh only
  progress.report_last(result.levels, result.mesh);
  return result;
}

}  // namespace

void check_room(const Mesh& coarse, const Options& options) {
  check_scheme(coarse, options);
  const Hooks nobody;
  const Progress progress(options, nobody);
  const uint64_t faces = coarse.topology.face_count();
  progress.require_room(faces, MemoryPlan(coarse, options).given(faces, 0), 0);
  if (options.max_faces > 0 && faces > options.max_faces)
    throw Error(Fault::result_too_large,
                "The mesh itself has " + std::to_string(faces) + " faces, more than max_faces, which is " +
                    std::to_string(options.max_faces) + ". Ask for more, or send a coarser mesh.");
  if (Selection(options, 1).is_uniform()) require_room_for_uniform(coarse, options, progress);
}

ShapeReport shape_of(Mesh coarse, const Options& options) {
  check_options(options);
  return guard_memory([&] {
    number_edges(coarse.topology);
    return mark_shape(coarse, options);
  });
}

bool uses_hierarchy(const Options& options) {
  return options.scheme == Scheme::red_green && (options.levels == 0 || !Selection(options, 1).is_uniform());
}

Result refine(Mesh coarse, const Options& options, const Hooks& hooks) {
  check_options(options);
  check_room(coarse, options);
  return guard_memory([&] {
    const double diagonal = bounding_box(coarse.positions).diagonal();
    number_edges(coarse.topology);
    const ShapeReport shape = mark_shape(coarse, options);
    Result result = run(std::move(coarse), diagonal, options, hooks);
    result.shape = shape;
    return result;
  });
}

Result refine(const PreparedMesh& coarse, const Options& options, const Hooks& hooks) {
  check_options(options);
  if (!coarse.suits(options))
    throw Error(Fault::bad_option, "The mesh was prepared for another tension, shape, w or crease angle.", "tension");
  check_room(coarse.coarse(), options);
  return guard_memory([&] {
    Result result = run(coarse, bounding_box(coarse.coarse().positions).diagonal(), options, hooks);
    result.shape = coarse.state().shape();
    return result;
  });
}

}  // namespace papilio
