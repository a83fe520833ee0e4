#include "refine.h"

#include <new>
#include <string>

#include "crease.h"
#include "in_place.h"
#include "progress.h"
#include "red_green.h"
#include "selection.h"
#include "simplify.h"

namespace papilio {
namespace {

Result run_scheme(Mesh mesh, const Options& options, const Selection& selection, const Progress& progress) {
  if (selection.is_uniform() && options.levels > 0)
    return refine_uniformly(std::move(mesh), options, selection, progress);
  if (options.scheme == Scheme::in_place) return refine_in_place(std::move(mesh), options, selection, progress);
  return refine_red_green(std::move(mesh), options, selection, progress);
}

Result run(Mesh mesh, const Options& options, const Hooks& hooks) {
  const Selection selection(options, bounding_box(mesh.positions).diagonal());
  const Progress progress(options, hooks);
  mark_creases(mesh, options.crease_angle);
  Result result = run_scheme(std::move(mesh), options, selection, progress);
  if (options.simplify_hidden) {
    progress.poll();
    result.mesh =
        simplify_hidden(std::move(result.mesh), *selection.camera(), default_hidden_error, [&] { progress.poll(); });
  }
  progress.report_last(result.levels, result.mesh);
  return result;
}

}  // namespace

void check_room(uint64_t faces, const Options& options) {
  const Progress progress(options, {});
  progress.require_room(faces, 0);
  if (options.max_faces > 0 && faces > options.max_faces)
    throw Error(Fault::result_too_large,
                "The mesh itself has " + std::to_string(faces) + " faces, more than max_faces, which is " +
                    std::to_string(options.max_faces) + ". Ask for more, or send a coarser mesh.");
  if (!Selection(options, 1).is_uniform()) return;
  for (int level = 1; level <= options.levels; ++level) progress.require_room(faces *= 4, level);
}

Result refine(Mesh coarse, const Options& options, const Hooks& hooks) {
  check_options(options);
  check_room(coarse.topology.face_count(), options);
  try {
    return run(std::move(coarse), options, hooks);
  } catch (const std::bad_alloc&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this result. Ask for fewer levels.");
  } catch (const std::length_error&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this result. Ask for fewer levels.");
  }
}

}  // namespace papilio
