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

constexpr uint64_t bytes_per_uniform_face = 70;  // arrays of a level and of the level before

class Uniform {
 public:
  Uniform(const Options& options, const Selection& selection, const Progress& progress)
      : options_(options), selection_(selection), progress_(progress) {}

  Result run(Mesh coarse) {
    detail_ = std::exchange(coarse.detail, nullptr);
    mesh_ = std::move(coarse);
    features_ = find_features(mesh_.topology);
    displacements_ = displacements_at_vertices(mesh_);
    const bool is_plain = options_.w == 0 && options_.tension == Tension::off;
    leaves_one_out_ =
        is_plain && !options_.edges && mesh_.attributes.empty() && !progress_.reports_levels() && features_.are_rings();
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
    const TrialContext context{
        .features = &features_, .parents = is_left_out() ? &parents_ : nullptr, .threads = progress_.threads()};
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
    const uint32_t vertices = topology.vertex_count;
    if (leaves_one_out_ && level_ + 1 == options_.levels) {
      parents_ = std::exchange(topology, {});
      topology.vertex_count = vertices + parents_.edge_count();
      return;
    }
    if (!mesh_.attributes.empty())
      split_with_attributes();
    else if (is_left_out())
      topology = split_last_in_sixteen(parents_, progress_.threads());
    else if (is_last() && !options_.edges)
      topology = split_last_in_four(topology, progress_.threads());
    else
      topology = split_in_four(topology, progress_.threads());
    if (!is_last()) descend(features_, vertices);
  }
  void split_with_attributes() {
    const Marks all(mesh_.topology.edge_count(), 1);
    Displacements displaced = split_displacements(displacements_, mesh_, options_, all);
    if (detail_ && level_ <= detail_->level_count())
      add_values_of_detail(mesh_, *detail_, level_ - 1, {}, displaced, progress_.cancelled());
    mesh_.topology = papilio::split(mesh_.topology, all, mesh_.positions, mesh_.attributes, displaced);
    append_new_vertices(displacements_, displaced, all);
  }

  /// Returns whether the connectivity of the level to be split was left out.
  [[nodiscard]] bool is_left_out() const { return leaves_one_out_ && is_last() && level_ > 1; }
  [[nodiscard]] uint32_t edge_count() const {
    return is_left_out() ? 2 * parents_.edge_count() + parents_.half_edge_count() : mesh_.topology.edge_count();
  }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  bool leaves_one_out_ = false;           ///< whether the level before the last is left out, as it is not reported
  int level_ = 0;                         ///< number of the level to be made
  Mesh mesh_;                             ///< level above `level_`; make_vertices() appends the vertices of `level_`
  Topology parents_;                      ///< connectivity two levels above, if a level is left out
  std::shared_ptr<const Detail> detail_;  ///< detail of the coarse mesh; may be null
  Features features_;                     ///< features of the level above, or of `parents_` if a level is left out
  Displacements displacements_;           ///< values at the vertices of the level above
  Result result_;
};

}  // namespace

void require_room_for_uniform(const Mesh& coarse, const Options& options, const Progress& progress) {
  const MemoryPlan plan(coarse, options);
  uint64_t faces = coarse.topology.face_count();
  for (int level = 1; level <= options.levels; ++level) {
    // A reported level may be encoded while the next is made.
    const uint64_t given_before = progress.reports_levels() ? plan.given(faces, level - 1) : 0;
    faces *= 4;
    progress.require_room(
        faces, std::max(plan.made(faces, level, bytes_per_uniform_face) + given_before, plan.given(faces, level)),
        level);
  }
}

Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  if (progress.reports_levels()) require_room_for_uniform(coarse, options, progress);  // otherwise check_room() did
  return Uniform(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
