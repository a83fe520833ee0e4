#include "schemes/uniform.h"

#include <algorithm>
#include <utility>

#include "hierarchy/detail_levels.h"
#include "hierarchy/memory_plan.h"
#include "mesh/attributes.h"
#include "mesh/normals.h"
#include "papilio/detail.h"
#include "rules/features.h"
#include "rules/split_displacements.h"
#include "schemes/uniform_error.h"
#include "split/split.h"
#include "split/split_in_four.h"

namespace papilio {
namespace {

constexpr uint64_t bytes_per_uniform_face = 70;  // of a level's arrays, while those of the level before are still there

class Uniform {
 public:
  Uniform(const Options& options, const Selection& selection, const Progress& progress)
      : options_(options),
        selection_(selection),
        progress_(progress),
        is_plain_(options.w == 0 && options.tension == Tension::off) {}

  Result run(Mesh coarse) {
    detail_ = std::exchange(coarse.detail, nullptr);
    mesh_ = std::move(coarse);
    features_ = find_features(mesh_.topology);
    displacements_ = displacements_at_vertices(mesh_);
    leaves_one_out_ =
        is_plain_ && !options_.edges && mesh_.attributes.empty() && !progress_.wants_levels() && features_.are_rings();
    for (level_ = 1; level_ <= options_.levels; ++level_) {
      progress_.poll();
      progress_.report(level_ - 1, mesh_);
      make_vertices();
      progress_.poll();
      if (is_last()) measure_error();
      split();
      result_.levels = level_;
    }
    result_.mesh = std::move(mesh_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_last() const { return level_ == options_.levels; }

  /// Appends the new vertices to the positions.
  void make_vertices() {
    if (detail_ && level_ <= detail_->level_count()) {
      const std::span<const Vec3f> made = detail_->new_vertices(level_ - 1, progress_.cancelled());
      mesh_.positions.insert(mesh_.positions.end(), made.begin(), made.end());
      return;
    }
    const Buffer<Vec3f> normals =
        options_.tension == Tension::off ? Buffer<Vec3f>{} : face_normals(mesh_, progress_.threads());
    mesh_.positions.resize_for_overwrite(mesh_.positions.size() + edge_count());
    const TrialContext context{.features = &features_,
                               .parents = is_plain_ && level_ > 1 ? &parents_ : nullptr,
                               .threads = progress_.threads()};
    papilio::make_vertices(mesh_, normals, options_, context, mesh_.positions.data() + mesh_.topology.vertex_count);
  }

  void measure_error() {
    if (!options_.measure_error || (detail_ && level_ == detail_->level_count())) return;  // the surface itself
    const Vec3f* made = mesh_.positions.data() + mesh_.topology.vertex_count;
    ErrorLeft left(selection_);
    left.add_distance(split_leaves *
                      (is_left_out() ? largest_deviation_below(parents_, mesh_.positions, made, progress_.threads())
                                     : largest_deviation(mesh_, made, progress_.threads())));
    result_.error = left.error();
  }

  void split() {
    Topology& topology = mesh_.topology;
    if (!is_last()) descend(features_, topology.vertex_count);
    if (!mesh_.attributes.empty()) {
      const SplitPlan plan = everything();
      Displacements displaced = split_displacements(displacements_, mesh_, options_, plan);
      if (detail_ && level_ <= detail_->level_count())
        add_values_of_detail(mesh_, *detail_, level_ - 1, {}, displaced, progress_.cancelled());
      Topology below = papilio::split(topology, plan, mesh_.positions, mesh_.attributes, displaced);
      append_new_vertices(displacements_, displaced, plan);
      keep_parents(std::exchange(topology, std::move(below)));
    } else if (is_left_out()) {
      topology = split_last_in_sixteen(parents_, progress_.threads());
    } else if (is_last() && !options_.edges) {
      topology = split_last_in_four(topology, progress_.threads());
    } else if (leaves_one_out_ && level_ + 1 == options_.levels) {
      Topology left_out;
      left_out.vertex_count = topology.vertex_count + topology.edge_count();
      keep_parents(std::exchange(topology, std::move(left_out)));
    } else {
      Topology below = split_in_four(topology, progress_.threads());
      keep_parents(std::exchange(topology, std::move(below)));
    }
  }

  void keep_parents(Topology parents) {
    if (is_plain_ && !is_last()) parents_ = std::move(parents);
  }

  /// Whether the level to be split is one whose connectivity was left out.
  [[nodiscard]] bool is_left_out() const { return leaves_one_out_ && is_last() && level_ > 1; }
  [[nodiscard]] uint32_t edge_count() const {
    return is_left_out() ? 2 * parents_.edge_count() + parents_.half_edge_count() : mesh_.topology.edge_count();
  }

  [[nodiscard]] SplitPlan everything() const { return SplitPlan(EdgeMarks(mesh_.topology.edge_count(), 1)); }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  const bool is_plain_;          ///< neither tension nor w: vertices follow from the level above, family by family
  bool leaves_one_out_ = false;  ///< and the last level from that two above it: nobody sees the one between
  int level_ = 0;                ///< at hand
  Mesh mesh_;                    ///< of the level above, with the vertices of this one once they are there
  Topology parents_;             ///< two levels above; where vertices are plain
  std::shared_ptr<const Detail> detail_;  ///< of the coarse mesh; may be null
  Features features_;
  Displacements displacements_;  ///< at the vertices of the level above
  Result result_;
};

}  // namespace

void require_room_for_uniform(const Mesh& coarse, const Options& options, const Progress& progress) {
  const MemoryPlan plan(coarse, options);
  uint64_t faces = coarse.topology.face_count();
  for (int level = 1; level <= options.levels; ++level) {
    // A level that the caller is given may be encoded while the next is made.
    const uint64_t given_before = progress.wants_levels() ? plan.given(faces, level - 1) : 0;
    faces *= 4;
    progress.require_room(
        faces, std::max(plan.made(faces, level, bytes_per_uniform_face) + given_before, plan.given(faces, level)),
        level);
  }
}

Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  if (progress.wants_levels()) require_room_for_uniform(coarse, options, progress);  // else check_room() has done it
  return Uniform(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
