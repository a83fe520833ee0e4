#include "red_green.h"

#include <algorithm>
#include <limits>

#include "assemble.h"
#include "attributes.h"
#include "hierarchy.h"
#include "transition.h"

namespace papilio {
namespace {

constexpr float never = -std::numeric_limits<float>::infinity();
constexpr uint64_t bytes_per_face = 160;  // of a level's arrays and of what is computed on it

/// No transition face gets an angle smaller than this share of the coarse mesh's smallest.
constexpr double sliver_share = 0.4;

class RedGreen {
 public:
  RedGreen(const Options& options, const Selection& selection, const Progress& progress)
      : options_(options), selection_(selection), progress_(progress), threshold_(selection.threshold()) {}

  Result run(Mesh coarse) {
    least_angle_ = sliver_share * smallest_angle(coarse);
    levels_.push_back(coarsest_level(std::move(coarse)));
    Mesh latest;  // the last level that changed something, when the caller wants to see levels
    if (progress_.wants_levels()) latest = levels_[0].mesh;
    Result result;
    for (int level = 1; level <= std::max(options_.levels, 1); ++level) {
      progress_.poll();
      try_level();
      progress_.poll();
      if (options_.levels == 0) break;  // tried for the sake of the error that is reported
      const bool changes = choose();
      if (changes) {
        progress_.report(result.levels, latest);
        progress_.require_room(count_assembled(levels_), level);
        result.levels = level;
        keep();
        if (progress_.wants_levels()) latest = assemble(levels_);
      }
      if (level == options_.levels || !go_deeper(level)) break;
    }
    finish(result, std::move(latest));
    return result;
  }

 private:
  /// Computes what splitting the lowest level would give, and the errors of its edges.
  void try_level() {
    HierarchyLevel& level = levels_.back();
    const bool is_last = static_cast<int>(levels_.size()) >= options_.levels;
    may_be_split_.push_back(edges_of_candidates(level));
    EdgeMarks wanted = may_be_split_.back();
    level.trial = try_split(level.mesh, options_, is_last ? wanted : complete_edges(level));
    selection_.narrow(level.mesh, level.trial.normals, static_cast<int>(levels_.size()), wanted);
    if (selection_.is_by_error()) {
      level.error = selection_.errors(level.mesh, level.trial, wanted, options_.max_faces > 0 ? 0 : threshold_);
    } else {
      level.error.assign(wanted.size(), never);
      for (size_t e = 0; e < wanted.size(); ++e)
        if (wanted[e] != 0) level.error[e] = threshold_;
    }
    level.split.assign(level.error.size(), 0);
  }

  /// Decides what is split. True when the lowest level changes anything.
  bool choose() {
    if (selection_.is_by_error())
      for (size_t k = levels_.size() - 1; k > 0; --k) carry_up(levels_[k], levels_[k - 1]);
    threshold_ = selection_.threshold();
    split_from(threshold_);
    if (options_.max_faces > 0) keep_within_budget();
    return std::ranges::any_of(levels_.back().split, [](uint8_t mark) { return mark != 0; });
  }

  /// An edge must be split as long as a child of one of its faces has an edge that is: else that child is not there.
  static void carry_up(const HierarchyLevel& below, HierarchyLevel& above) {
    for (size_t group = 0; group < below.parent.size(); ++group) {
      float needed = never;
      for (size_t h = 12 * group; h < 12 * group + 12; ++h)
        needed = std::max(needed, below.error[below.mesh.topology.edge[h]]);
      for (uint32_t i = 0; i < 3; ++i) {
        float& error = above.error[above.mesh.topology.edge[3 * below.parent[group] + i]];
        error = std::max(error, needed);
      }
    }
  }

  /// Marks what has at least this error, and what that needs so that no transition face becomes a sliver.
  void split_from(float threshold) {
    for (HierarchyLevel& level : levels_)
      for (size_t e = 0; e < level.error.size(); ++e) level.split[e] = level.error[e] >= threshold ? 1 : 0;
    for (size_t k = levels_.size(); k-- > 0;) {
      avoid_slivers(levels_[k], may_be_split_[k], least_angle_);
      if (k > 0) carry_marks_up(levels_[k], levels_[k - 1]);
    }
  }

  static void carry_marks_up(const HierarchyLevel& below, HierarchyLevel& above) {
    for (size_t h = 0; h < below.mesh.topology.edge.size(); ++h) {
      if (below.split[below.mesh.topology.edge[h]] == 0) continue;
      const uint32_t parent = below.parent[h / 12];
      for (uint32_t i = 0; i < 3; ++i) above.split[above.mesh.topology.edge[3 * parent + i]] = 1;
    }
  }

  /// Raises the threshold until no more is split than the budget allows. What avoiding slivers costs is known only
  /// afterwards; where it is too much, the errors themselves get that much less.
  void keep_within_budget() {
    const uint64_t coarse = levels_[0].mesh.topology.face_count();
    const std::vector<WeighedEdge> edges = weighed_edges();
    uint64_t room = options_.max_faces;
    for (uint64_t faces = count_assembled(levels_); faces > options_.max_faces; faces = count_assembled(levels_)) {
      float raised = threshold_within(edges, selection_.threshold(), coarse, room);
      while (raised <= threshold_) {
        room -= std::min(room - coarse, faces - options_.max_faces);
        raised = threshold_within(edges, selection_.threshold(), coarse, room);
      }
      threshold_ = raised;
      split_from(threshold_);
    }
    out_of_budget_ = threshold_ > selection_.threshold();
  }

  [[nodiscard]] std::vector<WeighedEdge> weighed_edges() const {
    std::vector<WeighedEdge> edges;
    for (const HierarchyLevel& level : levels_) append_edges(level.mesh.topology, level.error, edges);
    return edges;
  }

  /// Remembers what the result is made of. With a budget further levels can make it worse without changing anything
  /// themselves: what they need most is too much, and the threshold that leaves it out leaves out other edges too.
  void keep() {
    kept_.clear();
    for (const HierarchyLevel& level : levels_) kept_.push_back(level.split);
  }

  void bring_back_what_was_kept() {
    for (size_t k = 0; k < levels_.size(); ++k)
      if (k < kept_.size())
        levels_[k].split = std::move(kept_[k]);
      else
        std::ranges::fill(levels_[k].split, 0);
  }

  /// Makes the next level where it may be needed; false when it is needed nowhere.
  bool go_deeper(int level) {
    const std::vector<uint8_t> red = selection_.is_by_error() ? faces_to_look_into() : faces_to_divide();
    const auto count = [](const std::vector<uint8_t>& marks) {
      return static_cast<uint64_t>(std::ranges::count(marks, 1));
    };
    if (count(red) == 0) return false;
    const uint64_t faces = 4 * count(with_neighbours(levels_.back().mesh.topology, red));
    // What is held but not in the result is bounded too.
    progress_.require_room(faces / 4, level + 1);
    progress_.require_memory(faces, bytes_per_face + bytes_per_face_of(levels_[0].mesh.attributes), level + 1);
    if (faces > face_count_limit) progress_.require_room(faces, level + 1);
    levels_.push_back(refine_level(levels_.back(), red));
    return true;
  }

  [[nodiscard]] std::vector<uint8_t> faces_to_divide() const {
    const HierarchyLevel& level = levels_.back();
    std::vector<uint8_t> red(level.candidate);
    for (uint32_t h = 0; h < level.mesh.topology.half_edge_count(); ++h)
      if (level.split[level.mesh.topology.edge[h]] == 0) red[Topology::face(h)] = 0;
    return red;
  }

  /// Every face that touches one with an edge of large error, unless its edges may not be split. (Edges of half that
  /// error were tried too, and a tenth: results were the same.)
  [[nodiscard]] std::vector<uint8_t> faces_to_look_into() const {
    const HierarchyLevel& level = levels_.back();
    const Topology& mesh = level.mesh.topology;
    std::vector<uint8_t> faces(mesh.face_count(), 0);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
      if (level.error[mesh.edge[h]] >= threshold_) faces[Topology::face(h)] = 1;
    faces = with_neighbours(mesh, faces);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
      if (may_be_split_.back()[mesh.edge[h]] == 0) faces[Topology::face(h)] = 0;
    return faces;
  }

  void finish(Result& result, Mesh latest) {
    bring_back_what_was_kept();
    const ErrorLeft left = error_left(levels_, selection_);
    result.error = left.error();
    result.error_pixels = left.pixels();
    if (out_of_budget_)
      result.stop_reason = StopReason::budget;
    else
      result.stop_reason = result.levels == options_.levels ? StopReason::levels : StopReason::converged;
    if (!progress_.wants_levels()) latest = result.levels == 0 ? std::move(levels_[0].mesh) : assemble(levels_);
    result.mesh = std::move(latest);
  }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  std::vector<HierarchyLevel> levels_;
  std::vector<EdgeMarks> may_be_split_;  ///< [level] the edges of candidates
  double least_angle_ = 0;               ///< what transition faces keep to
  float threshold_;
  std::vector<EdgeMarks> kept_;  ///< [level] what was split when a level last changed something
  bool out_of_budget_ = false;
};

}  // namespace

Result refine_red_green(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  return RedGreen(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
