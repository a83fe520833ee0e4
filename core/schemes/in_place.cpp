#include "schemes/in_place.h"

#include <algorithm>

#include "criteria/budget.h"
#include "criteria/view_culling.h"
#include "hierarchy/memory_plan.h"
#include "mesh/displacement.h"
#include "rules/split_displacements.h"
#include "split/split.h"

namespace papilio {
namespace {

constexpr uint64_t bytes_per_in_place_face =
    130;  // of a level's arrays, while those of the level before are still there

class InPlace {
 public:
  InPlace(const Options& options, const Selection& selection, const Progress& progress)
      : options_(options), selection_(selection), progress_(progress) {}

  Result run(Mesh coarse) {
    mesh_ = std::move(coarse);
    displacements_ = displacements_at_vertices(mesh_);
    plan_.emplace(mesh_, options_);
    while (true) {
      progress_.poll();
      const int level = find_targets();
      if (level == 0) break;
      const SplitPlan plan(targets_);
      const uint64_t faces = count_children(mesh_.topology, plan);
      const uint64_t bytes = std::max(plan_->made(faces, level, bytes_per_in_place_face), plan_->given(faces, level));
      if (progress_.ends_before(faces, bytes)) {
        end_at_limit();
        break;
      }
      progress_.report(result_.levels, mesh_);
      progress_.require_room(faces, bytes, level);
      progress_.poll();
      split_targets(level, plan);
    }
    if (!out_of_budget_ && !is_at_limit_)
      result_.stop_reason = result_.levels == options_.levels ? StopReason::levels : StopReason::converged;
    result_.mesh = std::move(mesh_);
    return std::move(result_);
  }

 private:
  /// Finds the next level that has targets, and these; 0 when there is none. Notes the deviation that is left.
  int find_targets() {
    if (result_.levels == options_.levels && options_.levels > 0) return 0;  // its split edges are noted already
    trial_.emplace(try_split(mesh_, options_));
    trial_->forget();
    region_ = whole_region(mesh_.topology);
    box_ = bounding_box(mesh_.positions);
    if (selection_.camera() != nullptr) longest_ = longest_edges(mesh_);
    shown_ = selection_.shown(mesh_, *trial_, longest_, box_, shared_half_edges(mesh_.topology));
    const float least = options_.max_faces > 0 ? 0 : selection_.threshold();
    for (int level = result_.levels + 1; level <= options_.levels; ++level) {
      const Buffer<uint32_t> wanted = selection_.wanted(mesh_, *trial_, level, region_, shown_, box_, least);
      targets_.assign(mesh_.topology.edge_count(), 0);
      for (uint32_t e : wanted) targets_[e] = 1;
      if (selection_.is_by_error()) keep_largest_errors(wanted);
      if (SplitPlan(targets_).count() > 0) {
        note_error();
        return level;
      }
      if (!selection_.later_level_is_finer(level)) break;
    }
    targets_.assign(mesh_.topology.edge_count(), 0);
    note_error();
    return 0;
  }

  void keep_largest_errors(const Buffer<uint32_t>& wanted) {
    float threshold = selection_.threshold();
    const Buffer<float> errors = selection_.errors(mesh_, *trial_, wanted, box_, threshold);
    if (options_.max_faces > 0) {
      Buffer<WeighedEdge> edges;
      append_edges(mesh_.topology, region_, errors, threshold, edges);
      threshold = threshold_within(edges, threshold, mesh_.topology.face_count(), options_.max_faces);
      if (threshold > selection_.threshold()) {
        out_of_budget_ = true;
        result_.stop_reason = StopReason::budget;
      }
    }
    for (size_t e = 0; e < targets_.size(); ++e) targets_[e] = errors[e] >= threshold ? 1 : 0;
  }

  void note_error() {
    if (!options_.measure_error) return;
    ErrorLeft left(selection_);
    for (uint32_t e : region_.edges())
      if (shown_[e])
        left.add(mesh_, *trial_, selection_.highest_pixels_per_unit(box_), e, targets_[e] != 0 ? split_leaves : 1);
    result_.error = left.error();
    result_.error_pixels = left.pixels();
  }

  /// Nothing more is split: the error left is that of the mesh as it is.
  void end_at_limit() {
    is_at_limit_ = true;
    result_.stop_reason = StopReason::limits;
    targets_.assign(mesh_.topology.edge_count(), 0);
    note_error();
  }

  void split_targets(int level, const SplitPlan& plan) {
    const Displacements displaced = split_displacements(displacements_, mesh_, options_, plan);
    append_new_vertices(displacements_, displaced, plan);
    mesh_.positions.reserve(mesh_.positions.size() + plan.count());
    for (uint32_t e = 0; e < targets_.size(); ++e)
      if (targets_[e] != 0) mesh_.positions.push_back(trial_->at(e));
    mesh_.topology = split(mesh_.topology, plan, mesh_.positions, mesh_.attributes, displaced);
    result_.levels = level;
  }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  Mesh mesh_;
  Displacements displacements_;  ///< at its vertices
  std::optional<MemoryPlan> plan_;
  Result result_;
  std::optional<Trial> trial_;
  Region region_;
  Box box_;                 ///< all of the mesh
  Buffer<double> longest_;  ///< [V] edges (view_culling.h); empty without a view
  EdgesShown shown_;
  EdgeMarks targets_;
  bool out_of_budget_ = false;
  bool is_at_limit_ = false;
};

}  // namespace

Result refine_in_place(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  return InPlace(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
