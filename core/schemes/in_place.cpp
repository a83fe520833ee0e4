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

constexpr uint64_t bytes_per_in_place_face = 130;  // arrays of a level and of the level before

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
      const uint64_t faces = count_children(mesh_.topology, targets_);
      const uint64_t bytes = std::max(plan_->made(faces, level, bytes_per_in_place_face), plan_->given(faces, level));
      if (progress_.ends_before(faces, bytes)) {
        end_at_limit();
        break;
      }
      progress_.report(result_.levels, mesh_);
      progress_.require_room(faces, bytes, level);
      progress_.poll();
      split_targets(level);
    }
    if (!out_of_budget_ && !is_at_limit_)
      result_.stop_reason = result_.levels == options_.levels ? StopReason::levels : StopReason::converged;
    result_.mesh = std::move(mesh_);
    return std::move(result_);
  }

 private:
  /// Finds the targets of the next level that has any, and returns its number, or 0. Records the deviation left.
  int find_targets() {
    if (result_.levels == options_.levels && options_.levels > 0) return 0;  // the error is already recorded
    trial_.emplace(try_split(mesh_, options_));
    trial_->forget();
    region_ = whole_region(mesh_.topology);
    box_ = bounding_box(mesh_.positions);
    if (selection_.camera() != nullptr) longest_ = longest_edges(mesh_);
    shown_ = selection_.shown(mesh_, *trial_, longest_, shared_half_edges(mesh_.topology));
    const float least = options_.max_faces > 0 ? 0 : selection_.threshold();
    for (int level = result_.levels + 1; level <= options_.levels; ++level) {
      const Buffer<uint32_t> candidates = selection_.candidates(mesh_, *trial_, level, region_, shown_, box_, least);
      targets_.assign(mesh_.topology.edge_count(), 0);
      for (EdgeId e : candidates) targets_[e] = 1;
      if (selection_.is_by_error()) keep_largest_errors(candidates);
      if (std::ranges::find(targets_, 1) != targets_.end()) {
        note_error();
        return level;
      }
      if (!selection_.later_level_is_finer(level)) break;
    }
    targets_.assign(mesh_.topology.edge_count(), 0);
    note_error();
    return 0;
  }

  void keep_largest_errors(const Buffer<uint32_t>& candidates) {
    float threshold = selection_.threshold();
    const Buffer<float> errors = selection_.errors(mesh_, *trial_, candidates, threshold);
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
    for (EdgeId e : region_.edges())
      if (shown_[e])
        left.add(mesh_, *trial_, selection_.highest_pixels_per_unit(box_), e, targets_[e] != 0 ? split_leaves : 1);
    result_.error = left.error();
    result_.error_pixels = left.pixels();
  }

  /// Stops without further splits, and records the error of the present mesh.
  void end_at_limit() {
    is_at_limit_ = true;
    result_.stop_reason = StopReason::limits;
    targets_.assign(mesh_.topology.edge_count(), 0);
    note_error();
  }

  void split_targets(int level) {
    const Displacements displaced = split_displacements(displacements_, mesh_, options_, targets_);
    append_new_vertices(displacements_, displaced, targets_);
    const Buffer<uint32_t> targets = marked(targets_);
    mesh_.positions.reserve(mesh_.positions.size() + targets.size());
    for (EdgeId e : targets) mesh_.positions.push_back(trial_->at(e));
    mesh_.topology = split(mesh_.topology, targets_, mesh_.positions, mesh_.attributes, displaced);
    result_.levels = level;
  }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  Mesh mesh_;
  Displacements displacements_;  ///< values at the vertices of `mesh_`
  std::optional<MemoryPlan> plan_;
  Result result_;
  std::optional<Trial> trial_;
  Region region_;
  Box box_;                 ///< bounding box of `mesh_`
  Buffer<double> longest_;  ///< [V] longest edges (view_culling.h); empty without a view
  EdgesShown shown_;
  Marks targets_;
  bool out_of_budget_ = false;
  bool is_at_limit_ = false;
};

}  // namespace

Result refine_in_place(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  return InPlace(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
