#include "refine.h"

#include <cmath>
#include <new>
#include <string>

#include "in_place.h"
#include "normals.h"
#include "split.h"

namespace papilio {
namespace {

void require(bool good, const char* option, const std::string& what) {
  if (!good) throw Error(Fault::bad_option, what, option);
}

bool is_uniform(const Options& options) { return options.flatness.empty() && !options.view; }

void require_room(uint64_t faces, uint64_t limit, int level) {
  if (faces > limit)
    throw Error(Fault::result_too_large, "Level " + std::to_string(level) + " would have " + std::to_string(faces) +
                                             " faces; the limit is " + std::to_string(limit) +
                                             ". Ask for fewer levels or refine less of the mesh.");
}

double threshold_of(const Options& options, int level) {
  const auto index = static_cast<size_t>(level - 1);
  return index < options.flatness.size() ? options.flatness[index] : options.flatness.back();
}

/// Whether a level after this one could have targets where this one has none: its threshold is higher.
bool later_level_is_finer(const Options& options, int level) {
  if (options.flatness.empty()) return false;
  for (int later = level + 1; later <= options.levels; ++later)
    if (threshold_of(options, later) > threshold_of(options, level)) return true;
  return false;
}

/// The paper's method, in its order: mark by flatness, grow, cull by view.
EdgeMarks choose_targets(const Mesh& mesh, const Options& options, const std::optional<Camera>& camera, int level) {
  EdgeMarks marks(mesh.topology.edge_count(), options.flatness.empty() ? 1 : 0);
  if (is_uniform(options)) return marks;
  const std::vector<Vec3f> normals = face_normals(mesh);
  if (!options.flatness.empty()) {
    mark_by_flatness(mesh, normals, threshold_of(options, level), marks);
    grow(mesh.topology, options.growth, marks);
  }
  if (camera) cull_by_view(mesh, normals, *camera, options.view->edge_pixels, marks);
  return marks;
}

/// What a level splits.
struct NextLevel {
  int level;
  SplitPlan plan;
};

/// The first level after `level` that has targets; nothing when none is left.
std::optional<NextLevel> find_next_level(const Mesh& mesh, const Options& options, const std::optional<Camera>& camera,
                                         int level) {
  while (level < options.levels) {
    ++level;
    SplitPlan plan(choose_targets(mesh, options, camera, level));
    if (plan.count() > 0) return NextLevel{level, std::move(plan)};
    if (!later_level_is_finer(options, level)) break;
  }
  return std::nullopt;
}

Result run(Mesh mesh, const Options& options, const Hooks& hooks) {
  const auto poll = [&] {
    if (hooks.cancelled && hooks.cancelled()) throw Error(Fault::cancelled, "The caller asked to stop.");
  };
  std::optional<Camera> camera;
  if (options.view) camera.emplace(*options.view);
  check_room(mesh.topology.face_count(), options);

  Result result;
  while (true) {
    poll();
    const std::optional<NextLevel> next = find_next_level(mesh, options, camera, result.levels);
    if (hooks.on_level) hooks.on_level({result.levels, mesh, !next});
    if (!next) break;
    poll();
    require_room(count_children(mesh.topology, next->plan), std::min(options.face_limit, face_count_limit),
                 next->level);
    mesh = refine_in_place(std::move(mesh), next->plan, static_cast<float>(options.w));
    result.levels = next->level;
  }
  result.stop_reason = result.levels == options.levels ? StopReason::levels : StopReason::converged;
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace

void check_options(const Options& options) {
  require(options.levels >= 0 && options.levels <= 10, "levels", "The number of levels must lie in 0..10.");
  for (double t : options.flatness)
    require(t >= -1 && t <= 1, "flatness", "Each flatness threshold must lie in -1..1.");
  require(options.w >= -0.0625 && options.w <= 0.125, "w", "w must lie in -0.0625..0.125.");
  if (options.view) (void)Camera(*options.view);
}

void check_room(uint64_t faces, const Options& options) {
  require_room(faces, options.face_limit, 0);
  if (!is_uniform(options)) return;
  for (int level = 1; level <= options.levels; ++level) require_room(faces *= 4, options.face_limit, level);
}

Result refine(Mesh coarse, const Options& options, const Hooks& hooks) {
  check_options(options);
  try {
    return run(std::move(coarse), options, hooks);
  } catch (const std::bad_alloc&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this result. Ask for fewer levels.");
  } catch (const std::length_error&) {
    throw Error(Fault::out_of_memory, "There is not enough memory for this result. Ask for fewer levels.");
  }
}

}  // namespace papilio
