#include "red_green.h"

#include <algorithm>
#include <limits>

#include "assemble.h"
#include "hierarchy.h"
#include "transition.h"

namespace papilio {
namespace {

constexpr float never = -std::numeric_limits<float>::infinity();
constexpr uint64_t bytes_per_face = 160;  // of a level's arrays and of what is computed on it

/// A face may be divided where one of its edges, or one near it, has at least this share of the error that counts:
/// further down errors can be larger than they are here.
constexpr float look_ahead = 0.5F;

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
        progress_.require_room(count_assembled(levels_, threshold_), level);
        result.levels = level;
        keep();
        if (progress_.wants_levels()) latest = assemble(levels_, threshold_);
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
    EdgeMarks wanted = edges_of_candidates(level);
    level.trial = try_split(level.mesh, options_, is_last ? wanted : complete_edges(level));
    selection_.narrow(level.mesh, level.trial.normals, static_cast<int>(levels_.size()), wanted);
    if (selection_.is_by_error()) {
      level.error = selection_.errors(level.mesh, level.trial, wanted, look_ahead * threshold_);
    } else {
      level.error.assign(wanted.size(), never);
      for (size_t e = 0; e < wanted.size(); ++e)
        if (wanted[e] != 0) level.error[e] = threshold_;
    }
    own_error_ = level.error;
  }

  /// Carries the new errors up and finds the threshold. True when the lowest level changes anything.
  bool choose() {
    for (size_t k = levels_.size(); k-- > 0;) {
      avoid_slivers(levels_[k], edges_of_candidates(levels_[k]), least_angle_, threshold_);
      if (k == 0 || !selection_.is_by_error()) break;
      carry_up(levels_[k], levels_[k - 1]);
    }
    if (options_.max_faces > 0) keep_within_budget();
    return std::ranges::any_of(levels_.back().error, [&](float e) { return e >= threshold_; });
  }

  /// An edge must be split as long as a child of one of its faces has an edge that is: else that child is not there.
  static void carry_up(const HierarchyLevel& below, HierarchyLevel& above) {
    const auto& edge = below.mesh.topology.edge;
    for (size_t group = 0; group < below.parent.size(); ++group) {
      float needed = never;
      for (size_t h = 12 * group; h < 12 * group + 12; ++h) needed = std::max(needed, below.error[edge[h]]);
      for (uint32_t i = 0; i < 3; ++i) {
        float& error = above.error[above.mesh.topology.edge[3 * below.parent[group] + i]];
        error = std::max(error, needed);
      }
    }
  }

  void keep_within_budget() {
    std::vector<WeighedEdge> edges;
    for (const HierarchyLevel& level : levels_) {
      const size_t begin = edges.size();
      for (float error : level.error) edges.push_back({error, 0});
      for (uint32_t e : level.mesh.topology.edge) ++edges[begin + e].faces;
    }
    threshold_ = threshold_within(std::move(edges), selection_.threshold(), levels_[0].mesh.topology.face_count(),
                                  options_.max_faces);
    out_of_budget_ = threshold_ > selection_.threshold();
  }

  /// Remembers what the result is made of. With a budget further levels can make it worse without changing anything
  /// themselves: what they need most is too much, and the threshold that leaves it out leaves out other edges too.
  void keep() {
    if (options_.max_faces == 0) return;
    kept_threshold_ = threshold_;
    kept_errors_.clear();
    for (const HierarchyLevel& level : levels_) kept_errors_.push_back(level.error);
  }

  void bring_back_what_was_kept() {
    if (options_.max_faces == 0) return;
    threshold_ = kept_threshold_;
    for (size_t k = 0; k < levels_.size(); ++k)
      if (k < kept_errors_.size())
        levels_[k].error = std::move(kept_errors_[k]);
      else
        std::ranges::fill(levels_[k].error, never);
  }

  /// Makes the next level where it may be needed; false when it is needed nowhere.
  bool go_deeper(int level) {
    const std::vector<uint8_t> red = selection_.is_by_error() ? faces_to_look_into() : faces_to_divide();
    const auto count = [](const std::vector<uint8_t>& marks) {
      return static_cast<uint64_t>(std::ranges::count(marks, 1));
    };
    if (count(red) == 0) return false;
    const uint64_t faces = 4 * count(with_neighbours(levels_.back().mesh.topology, red));
    progress_.require_memory(faces, bytes_per_face, level + 1);
    if (faces > face_count_limit) progress_.require_room(faces, level + 1);
    levels_.push_back(refine_level(levels_.back(), red));
    return true;
  }

  [[nodiscard]] std::vector<uint8_t> faces_to_divide() const {
    const HierarchyLevel& level = levels_.back();
    std::vector<uint8_t> red(level.candidate);
    for (uint32_t h = 0; h < level.mesh.topology.half_edge_count(); ++h)
      if (!(level.error[level.mesh.topology.edge[h]] >= threshold_)) red[Topology::face(h)] = 0;
    return red;
  }

  /// Every face that touches one with an edge of large error, unless its edges may not be split.
  [[nodiscard]] std::vector<uint8_t> faces_to_look_into() const {
    const HierarchyLevel& level = levels_.back();
    const Topology& mesh = level.mesh.topology;
    const float least = look_ahead * threshold_;
    std::vector<uint8_t> faces(mesh.face_count(), 0);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
      if (own_error_[mesh.edge[h]] >= least) faces[Topology::face(h)] = 1;
    faces = with_neighbours(mesh, faces);
    const EdgeMarks may_be_split = edges_of_candidates(level);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
      if (may_be_split[mesh.edge[h]] == 0) faces[Topology::face(h)] = 0;
    return faces;
  }

  void finish(Result& result, Mesh latest) {
    bring_back_what_was_kept();
    const ErrorLeft left = error_left(levels_, options_.levels == 0 ? infinite : threshold_, selection_);
    result.error = left.error();
    result.error_pixels = left.pixels();
    if (out_of_budget_)
      result.stop_reason = StopReason::budget;
    else
      result.stop_reason = result.levels == options_.levels ? StopReason::levels : StopReason::converged;
    if (!progress_.wants_levels())
      latest = result.levels == 0 ? std::move(levels_[0].mesh) : assemble(levels_, threshold_);
    result.mesh = std::move(latest);
  }

  static constexpr float infinite = std::numeric_limits<float>::infinity();
  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  std::vector<HierarchyLevel> levels_;
  std::vector<float> own_error_;  ///< [E] of the lowest level, before errors from below are carried up
  double least_angle_ = 0;        ///< what transition faces keep to
  float threshold_;
  float kept_threshold_ = selection_.threshold();
  std::vector<std::vector<float>> kept_errors_;  ///< [levels][E]
  bool out_of_budget_ = false;
};

}  // namespace

Result refine_red_green(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  return RedGreen(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
