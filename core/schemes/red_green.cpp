#include "schemes/red_green.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "criteria/budget.h"
#include "hierarchy/assemble.h"
#include "hierarchy/detail_levels.h"
#include "hierarchy/displaced_levels.h"
#include "hierarchy/error_left.h"
#include "hierarchy/exploration.h"
#include "hierarchy/level_choice.h"
#include "hierarchy/outline.h"
#include "hierarchy/repair.h"
#include "hierarchy/surface_check.h"
#include "hierarchy/transition.h"

namespace papilio {
namespace {

/// Share of the tolerance that repair() keeps to: distances are sampled, and levels that add little are not explored.
constexpr double share_of_tolerance = 0.97;
/// Share of the tolerance from which edges are split for their own error. Those just below the tolerance nearly all
/// have to be split by repair(), which takes longer.
constexpr float share_chosen_by_error = 0.88F;
/// Share of an upper bound that a sampled distance must exceed for the bound to be tight enough.
constexpr double least_share_of_bound = 0.5;
constexpr float no_edge = -std::numeric_limits<float>::infinity();

class RedGreen {
 public:
  RedGreen(Levels levels, const Options& options, const Selection& selection, const Progress& progress)
      : options_(options),
        selection_(selection),
        progress_(progress),
        levels_(std::move(levels)),
        least_error_(selection.threshold() *
                     (bounds_distance() && selection.camera() == nullptr ? share_chosen_by_error : 1)),
        threshold_(least_error_),
        exploration_(options, selection, levels_.plan(), progress) {}

  Result run() {
    choices_.push_back(choose_coarsest(levels_.deepest()));
    Mesh latest;  // last level that changed the mesh, if levels are reported
    if (progress_.reports_levels()) latest = choices_[0].level->mesh;
    Result result;
    for (int level = 1; level <= std::max(options_.levels, 1); ++level) {
      progress_.poll();
      weigh_edges();
      progress_.poll();
      if (options_.levels == 0) break;  // the result's error needs weighed edges
      const bool changes = choose();
      if (changes) {
        const uint64_t faces = count_assembled(choices_);
        const uint64_t bytes = levels_.plan().given(faces, level);
        is_at_limit_ = progress_.ends_before(faces, bytes);
        if (is_at_limit_) break;
        progress_.report(result.levels, latest);
        progress_.require_room(faces, bytes, level);
        result.levels = level;
        keep();
        if (progress_.reports_levels()) latest = assembled();
      }
      if (level == options_.levels || !go_deeper(level)) break;
    }
    if (bounds_distance() && has_limit() && !out_of_budget_ && !is_at_limit_ && repair(result.levels)) {
      keep();
      if (progress_.reports_levels()) latest = assembled();
    }
    finish(result, std::move(latest));
    levels_.hand_back();
    return result;
  }

 private:
  /// Returns whether the distance to the uniform surface is bounded, as errors alone decide.
  [[nodiscard]] bool bounds_distance() const {
    return selection_.is_by_error() && options_.flatness.empty() && options_.levels > 0 &&
           (selection_.camera() == nullptr || is_view_verified(*options_.view));
  }
  [[nodiscard]] static bool is_view_verified(const View& view) {
    return view.verify && view.error_pixels > 0 && view.edge_pixels == 0 && view.lights.empty();
  }
  [[nodiscard]] bool has_limit() const { return options_.tolerance > 0 || selection_.camera() != nullptr; }

  /// Returns a share of the requested limit.
  [[nodiscard]] DistanceLimit limit(double share) const {
    DistanceLimit limit{.everywhere = share * options_.tolerance * selection_.diagonal()};
    if (selection_.camera() == nullptr) return limit;
    limit.camera = selection_.camera();
    limit.pixels = share * options_.view->error_pixels;
    return limit;
  }

  /// Computes the candidates of the lowest level, and their errors if these decide.
  void weigh_edges() {
    LevelChoice& choice = choices_.back();
    const HierarchyLevel& level = *choice.level;
    choice.shown = selection_.shown(level.mesh, level.trial, level.longest, level.shared);
    const float least = options_.max_faces > 0 ? 0 : threshold_;
    Buffer<uint32_t> candidates = selection_.candidates(level.mesh, level.trial, static_cast<int>(choices_.size()),
                                                        choice.region, choice.shown, level.box, least);
    if (!selection_.is_by_error()) {
      choice.candidates = std::move(candidates);
      return;
    }
    choice.error = selection_.errors(level.mesh, level.trial, candidates, least);
    choice.candidates = std::move(candidates);
    keep_if(choice.candidates, [&](EdgeId e) { return choice.error[e] >= least_error_; });
  }

  /// Chooses the edges to split. Returns whether the lowest level has any.
  bool choose() {
    if (!selection_.is_by_error()) {
      split_deepest();
      if (selection_.follows_outline()) divide_at_outlines(choices_);
    } else {
      for (size_t k = choices_.size() - 1; k > 0; --k) carry_up(choices_[k], choices_[k - 1]);
      threshold_ = least_error_;
      split_from(threshold_);
      if (options_.max_faces > 0) keep_within_budget();
    }
    return !choices_.back().split_edges.empty();
  }

  /// Splits the candidates of the lowest level, if errors do not decide. Levels above change only at an outline.
  void split_deepest() {
    LevelChoice& choice = choices_.back();
    choice.split_first(choice.candidates);
    avoid_slivers(choice);
  }

  /// Raises errors of the level above to the largest error below each face: children exist only if all its edges are
  /// split.
  void carry_up(const LevelChoice& below, LevelChoice& above) const {
    const float least = least_error_;
    below.visit_parents([&](uint32_t parent, const uint32_t* edges) {
      float largest = no_edge;
      for (uint32_t i = 0; i < 12; ++i) largest = std::max(largest, below.error[edges[i]]);
      if (!(largest >= least)) return;
      for (uint32_t i = 0; i < 3; ++i) {
        const EdgeId e = above.level->mesh.topology.edge[3 * parent + i];
        if (above.error[e] < least) above.candidates.push_back(e);
        above.error[e] = std::max(above.error[e], largest);
      }
    });
  }

  /// Splits the edges with at least this error, and further edges to avoid slivers.
  void split_from(float threshold) {
    for (LevelChoice& choice : choices_) {
      choice.split_nothing();
      Buffer<uint32_t> edges = choice.candidates;
      if (!choice.error.empty()) keep_if(edges, [&](EdgeId e) { return choice.error[e] >= threshold; });
      choice.split_first(std::move(edges));
    }
    for (size_t k = choices_.size(); k-- > 0;) {
      avoid_slivers(choices_[k]);
      if (k > 0) carry_marks_up(choices_[k], choices_[k - 1]);
    }
  }

  static void carry_marks_up(const LevelChoice& below, LevelChoice& above) {
    if (below.split_edges.empty()) return;
    below.visit_parents([&](uint32_t parent, const uint32_t* /*edges*/) {
      if (below.splits_below(parent)) above.divide(parent);
    });
  }

  /// Raises the threshold until the result is within the budget. The faces that avoid slivers are known only
  /// afterwards; their excess is deducted from the room of the edges with errors.
  void keep_within_budget() {
    const uint64_t coarse = choices_[0].region.faces.size();
    const Buffer<WeighedEdge> edges = weighed_edges();
    uint64_t room = options_.max_faces;
    for (uint64_t faces = count_assembled(choices_); faces > options_.max_faces; faces = count_assembled(choices_)) {
      float raised = threshold_within(edges, least_error_, coarse, room);
      while (raised <= threshold_) {
        room -= std::min(room - coarse, faces - options_.max_faces);
        raised = threshold_within(edges, least_error_, coarse, room);
      }
      threshold_ = raised;
      split_from(threshold_);
    }
    out_of_budget_ = threshold_ > least_error_;
  }

  [[nodiscard]] Buffer<WeighedEdge> weighed_edges() const {
    Buffer<WeighedEdge> edges;
    for (const LevelChoice& choice : choices_)
      append_edges(choice.level->mesh.topology, choice.region, choice.error, least_error_, edges);
    return edges;
  }

  /// Keeps the splits of the result if a further level may have to be undone: one that exceeds a limit, or one that
  /// raises the threshold within a budget, so that the error grows.
  void keep() {
    if (!may_take_back()) return;
    kept_ = splits_of(choices_);
  }

  [[nodiscard]] bool may_take_back() const { return options_.max_faces > 0 || options_.stop_at_limits; }

  void restore_kept() {
    if (may_take_back()) set_splits(choices_, kept_);
  }

  /// Makes the next level below faces that may be divided; returns false if there are none, or no room.
  bool go_deeper(int level) {
    const Buffer<uint32_t> red = selection_.is_by_error()
                                     ? exploration_.faces_to_look_into(choices_, threshold_, limit_to_explore())
                                     : faces_to_divide();
    if (red.empty()) return false;
    mark_red(choices_.back(), red);
    if (!has_room_below(level + 1)) return false;
    levels_.deepen(choices_.back().red);
    choices_.push_back(choose_below(choices_.back(), levels_.deepest()));
    return true;
  }

  /// Returns whether the level is within the limits. Throws beyond a limit, unless the options stop there. Held faces
  /// count even if they are not in the result, but not those held for other requests. Detail is decoded for whole
  /// levels.
  [[nodiscard]] bool has_room_below(int level) {
    const LevelChoice& choice = choices_.back();
    if (choice.level->detail_levels > 1) {
      const DecodedSize size = decoded_size(coarse(), level, levels_.plan());
      // A bounded distance requires all levels.
      is_at_limit_ = !bounds_distance() && progress_.ends_before(size.faces, size.bytes);
      if (is_at_limit_) return false;
      progress_.require_room(size.faces, size.bytes, level);
    }
    const Topology& mesh = choice.level->mesh.topology;
    const auto bytes = [&](uint64_t faces) { return levels_.plan().made(faces, level, bytes_per_held_face); };
    if (progress_.has_room(4ULL * mesh.face_count(), bytes(4ULL * mesh.face_count()))) return true;
    const auto parents = static_cast<uint64_t>(std::ranges::count(choice.with_children(), 1));
    const bool are_too_many = 4 * parents > face_count_limit;
    is_at_limit_ = progress_.ends_before(parents, bytes(4 * parents)) || (are_too_many && options_.stop_at_limits);
    if (is_at_limit_) return false;
    progress_.require_room(are_too_many ? 4 * parents : parents, bytes(4 * parents), level);
    return true;
  }

  /// Returns the bound of the distance at the present threshold; nothing if it is not bounded.
  [[nodiscard]] std::optional<DistanceLimit> limit_to_explore() const {
    if (!bounds_distance()) return std::nullopt;
    if (has_limit()) return limit(threshold_ / least_error_);
    return DistanceLimit{.everywhere = threshold_ * selection_.diagonal()};
  }

  /// Returns the divided faces of the lowest level, and its faces at an outline.
  [[nodiscard]] Buffer<uint32_t> faces_to_divide() {
    LevelChoice& choice = choices_.back();
    Buffer<uint32_t> red = chosen(choice.region.faces, [&](FaceId f) { return choice.split_mask(f) == 7; });
    if (selection_.follows_outline()) add_faces_at_outline(choice, static_cast<int>(choices_.size()), selection_, red);
    return red;
  }

  /// Splits further edges until the result is within the tolerance of the uniform surface, subject to budget and
  /// limits. Returns whether any edge was split.
  bool repair(int& level) {
    Repair repair(choices_, least_error_, allowed(share_of_tolerance), options_.levels, progress_);
    bool has_repaired = false;
    while (repair.add_candidates()) {
      progress_.poll();
      const Splits before = splits_of(choices_);
      split_from(threshold_);
      if (!is_allowed(level)) {
        set_splits(choices_, before);
        return has_repaired;
      }
      has_repaired = true;
      for (size_t k = 0; k < choices_.size(); ++k)
        if (!choices_[k].split_edges.empty()) level = std::max(level, static_cast<int>(k) + 1);
      repair.look_again();
    }
    is_within_limit_ = repair.is_complete();
    // Otherwise the distance is measured, which takes longer.
    is_limit_near_ =
        is_within_limit_ && (has_repaired || selection_.camera() != nullptr) && repair.exceeds(least_share_of_bound);
    return has_repaired;
  }

  /// Returns the allowed distance for a share of the requested limit.
  [[nodiscard]] AllowedDistance allowed(double share) const {
    if (selection_.camera() == nullptr) return AllowedDistance(limit(share).everywhere);
    return {choices_, limit(share)};
  }

  /// Returns whether the result is within budget and limits; throws beyond a limit, unless the options stop there.
  [[nodiscard]] bool is_allowed(int level) {
    const uint64_t faces = count_assembled(choices_);
    const uint64_t bytes = levels_.plan().given(faces, level);
    out_of_budget_ = options_.max_faces > 0 && faces > options_.max_faces;
    is_at_limit_ = progress_.ends_before(faces, bytes);
    if (out_of_budget_ || is_at_limit_) return false;
    progress_.require_room(faces, bytes, level);
    return true;
  }

  [[nodiscard]] Mesh assembled() const {
    return assemble(choices_, options_.edges || options_.simplify_hidden, displacements_of(choices_, options_));
  }

  [[nodiscard]] const Mesh& coarse() const { return choices_[0].level->mesh; }
  [[nodiscard]] bool has_detail() const { return coarse().detail != nullptr; }
  [[nodiscard]] bool is_uniform() const {
    const uint64_t coarse = choices_[0].region.faces.size();
    return count_assembled(choices_) == coarse << (2 * static_cast<uint64_t>(options_.levels));
  }

  /// Returns an upper bound of the distance to the uniform surface.
  [[nodiscard]] double distance() const {
    if (has_detail() && is_uniform()) return 0;
    const double limit_kept = limit(share_of_tolerance).everywhere;
    if (is_limit_near_) return limit_kept;
    const double found = surface_check(AllowedDistance(1)).largest_share();
    // Below faces that were not explored, `found` may exceed the limit that repair() has verified.
    return is_within_limit_ ? std::min(found, limit_kept) : found;
  }

  /// Returns an upper bound of the visible distance to the uniform surface, in pixels.
  [[nodiscard]] double distance_in_pixels() const {
    if (has_detail() && is_uniform()) return 0;
    if (is_limit_near_) return options_.view->error_pixels * share_of_tolerance;
    const SurfaceCheck check = surface_check(allowed(1));
    return options_.view->error_pixels *
           (is_within_limit_ ? std::min(check.largest_bound(), share_of_tolerance) : check.largest_share());
  }

  [[nodiscard]] SurfaceCheck surface_check(AllowedDistance allowed) const {
    return {choices_, options_.levels, std::move(allowed), 0, progress_};
  }

  void finish(Result& result, Mesh latest) {
    restore_kept();
    if (options_.measure_error) {
      const ErrorLeft left = error_left(choices_, selection_);
      result.error = left.error();
      result.error_pixels = left.pixels();
      if (bounds_distance() && selection_.camera() == nullptr && selection_.diagonal() > 0)
        result.error = std::max(result.error, distance() / selection_.diagonal());
      else if (bounds_distance() && selection_.camera() != nullptr && options_.tolerance == 0)
        result.error_pixels = std::max(result.error_pixels, distance_in_pixels());
    }
    if (out_of_budget_)
      result.stop_reason = StopReason::budget;
    else if (is_at_limit_)
      result.stop_reason = StopReason::limits;
    else
      result.stop_reason = result.levels == options_.levels ? StopReason::levels : StopReason::converged;
    if (progress_.reports_levels())
      result.mesh = std::move(latest);
    else if (result.levels == 0)
      result.mesh = choices_[0].level->mesh;
    else
      result.mesh = assembled();
  }

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  Levels levels_;
  std::vector<LevelChoice> choices_;  ///< [level]
  float least_error_;                 ///< edges of smaller errors are split by repair() alone
  float threshold_;                   ///< lower bound of the errors of edges to split; least_error_ within the budget
  Splits kept_;                       ///< [level] edges split when a level last changed the mesh
  Exploration exploration_;
  bool is_within_limit_ = false;  ///< whether repair() ended within the limit
  bool is_limit_near_ = false;    ///< whether a bound that is the limit is tight enough
  bool out_of_budget_ = false;
  bool is_at_limit_ = false;
};

}  // namespace

Result refine_red_green(Levels levels, const Options& options, const Selection& selection, const Progress& progress) {
  return RedGreen(std::move(levels), options, selection, progress).run();
}

}  // namespace papilio
