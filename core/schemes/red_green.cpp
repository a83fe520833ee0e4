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

/// Within this share of the tolerance the result is repaired: distances are sampled, if densely, and levels that would
/// add no more than a small share are not explored.
constexpr double share_of_tolerance = 0.97;
constexpr float no_edge = -std::numeric_limits<float>::infinity();

class RedGreen {
 public:
  RedGreen(Levels levels, const Options& options, const Selection& selection, const Progress& progress)
      : options_(options),
        selection_(selection),
        progress_(progress),
        levels_(std::move(levels)),
        most_cosine_(most_cosine_beside(levels_.smallest_angle())),
        threshold_(selection.threshold()),
        exploration_(options, selection, levels_.plan(), progress) {}

  Result run() {
    choices_.push_back(choose_coarsest(levels_.deepest()));
    Mesh latest;  // the last level that changed something, when the caller wants to see levels
    if (progress_.wants_levels()) latest = choices_[0].level->mesh;
    Result result;
    for (int level = 1; level <= std::max(options_.levels, 1); ++level) {
      progress_.poll();
      weigh_edges();
      progress_.poll();
      if (options_.levels == 0) break;  // weighed for the sake of the error that is reported
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
        if (progress_.wants_levels()) latest = assembled();
      }
      if (level == options_.levels || !go_deeper(level)) break;
    }
    if (bounds_distance() && has_limit() && !out_of_budget_ && !is_at_limit_ && repair(result.levels)) {
      keep();
      if (progress_.wants_levels()) latest = assembled();
    }
    finish(result, std::move(latest));
    levels_.hand_back();
    return result;
  }

 private:
  /// Whether the distance to the uniform surface is bounded: where errors decide, and nothing else.
  [[nodiscard]] bool bounds_distance() const {
    return selection_.is_by_error() && options_.flatness.empty() && options_.levels > 0 &&
           (selection_.camera() == nullptr || is_view_verified(*options_.view));
  }
  [[nodiscard]] static bool is_view_verified(const View& view) {
    return view.verify && view.error_pixels > 0 && view.edge_pixels == 0 && view.lights.empty();
  }
  [[nodiscard]] bool has_limit() const { return options_.tolerance > 0 || selection_.camera() != nullptr; }

  /// What is asked for, or a share of that.
  [[nodiscard]] DistanceLimit limit(double share) const {
    DistanceLimit limit{.everywhere = share * options_.tolerance * selection_.diagonal()};
    if (selection_.camera() == nullptr) return limit;
    limit.camera = selection_.camera();
    limit.pixels = share * options_.view->error_pixels;
    return limit;
  }

  /// Finds how much the edges of the lowest level want to be split.
  void weigh_edges() {
    LevelChoice& choice = choices_.back();
    const HierarchyLevel& level = *choice.level;
    choice.shown = selection_.shown(level.mesh, level.trial, level.longest, level.box, level.shared);
    const float least = options_.max_faces > 0 ? 0 : threshold_;
    Buffer<uint32_t> wanted = selection_.wanted(level.mesh, level.trial, static_cast<int>(choices_.size()),
                                                choice.region, choice.shown, level.box, least);
    if (!selection_.is_by_error()) {
      choice.candidates = std::move(wanted);
      return;
    }
    choice.error = selection_.errors(level.mesh, level.trial, wanted, level.box, least, reaching());
    choice.candidates = std::move(wanted);
    keep_if(choice.candidates, [&](uint32_t e) { return choice.error[e] >= selection_.threshold(); });
  }

  /// With a budget errors are compared with each other, too; and where nothing is split, they are what is left.
  [[nodiscard]] Selection::Reaching reaching() const {
    return options_.max_faces > 0 || options_.levels == 0 ? Selection::Reaching::exact : Selection::Reaching::no_more;
  }

  /// Decides what is split. True when the lowest level changes anything.
  bool choose() {
    if (!selection_.is_by_error()) {
      split_deepest();
      if (selection_.follows_outline()) divide_at_outlines(choices_, most_cosine_);
    } else {
      for (size_t k = choices_.size() - 1; k > 0; --k) carry_up(choices_[k], choices_[k - 1]);
      threshold_ = selection_.threshold();
      split_from(threshold_);
      if (options_.max_faces > 0) keep_within_budget();
    }
    return !choices_.back().split_edges.empty();
  }

  /// Where errors do not decide: below divided faces all is as wanted, and above nothing changes but at an outline.
  void split_deepest() {
    LevelChoice& choice = choices_.back();
    choice.split_first(choice.candidates);
    avoid_slivers(choice, most_cosine_);
  }

  /// An edge must be split as long as a child of one of its faces has an edge that is: else that child is not there.
  void carry_up(const LevelChoice& below, LevelChoice& above) const {
    const float least = selection_.threshold();
    below.visit_parents([&](uint32_t parent, const uint32_t* edges) {
      float largest = no_edge;
      for (uint32_t i = 0; i < 12; ++i) largest = std::max(largest, below.error[edges[i]]);
      if (!(largest >= least)) return;
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t e = above.level->mesh.topology.edge[3 * parent + i];
        if (above.error[e] < least) above.candidates.push_back(e);
        above.error[e] = std::max(above.error[e], largest);
      }
    });
  }

  /// Marks what has at least this error, and what that needs so that no transition face becomes a sliver.
  void split_from(float threshold) {
    for (LevelChoice& choice : choices_) {
      choice.split_nothing();
      Buffer<uint32_t> edges = choice.candidates;
      if (!choice.error.empty()) keep_if(edges, [&](uint32_t e) { return choice.error[e] >= threshold; });
      choice.split_first(std::move(edges));
    }
    for (size_t k = choices_.size(); k-- > 0;) {
      avoid_slivers(choices_[k], most_cosine_);
      if (k > 0) carry_marks_up(choices_[k], choices_[k - 1]);
    }
  }

  static void carry_marks_up(const LevelChoice& below, LevelChoice& above) {
    if (below.split_edges.empty()) return;
    below.visit_parents([&](uint32_t parent, const uint32_t* edges) {
      unsigned any = 0;
      for (uint32_t i = 0; i < 12; ++i) any |= below.split[edges[i]];
      if (any == 0) return;
      for (uint32_t i = 0; i < 3; ++i) above.split_edge(above.level->mesh.topology.edge[3 * parent + i]);
    });
  }

  /// Raises the threshold until no more is split than the budget allows. What avoiding slivers costs is known only
  /// afterwards; where it is too much, the errors themselves get that much less.
  void keep_within_budget() {
    const uint64_t coarse = choices_[0].region.faces.size();
    const Buffer<WeighedEdge> edges = weighed_edges();
    uint64_t room = options_.max_faces;
    for (uint64_t faces = count_assembled(choices_); faces > options_.max_faces; faces = count_assembled(choices_)) {
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

  [[nodiscard]] Buffer<WeighedEdge> weighed_edges() const {
    Buffer<WeighedEdge> edges;
    for (const LevelChoice& choice : choices_)
      append_edges(choice.level->mesh.topology, choice.region, choice.error, selection_.threshold(), edges);
    return edges;
  }

  /// Remembers the splits that the result is made of, where a further level may have to be taken back: one that passes
  /// a limit, or with a budget one that raises the threshold so far that the result has a larger error.
  void keep() {
    if (!may_take_back()) return;
    kept_ = splits_of(choices_);
  }

  [[nodiscard]] bool may_take_back() const { return options_.max_faces > 0 || options_.stop_at_limits; }

  void bring_back_what_was_kept() {
    if (may_take_back()) set_splits(choices_, kept_);
  }

  /// Makes the next level where it may be needed; false when it is needed nowhere.
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

  /// Whether the level may be made; throws where it passes a limit and the options do not end there. Faces that are
  /// held but not in the result count too; those held for other requests do not. Detail is decoded for whole levels.
  [[nodiscard]] bool has_room_below(int level) {
    const LevelChoice& choice = choices_.back();
    if (choice.level->detail_levels > 1) {
      const DecodedSize size = decoded_size(coarse(), level, levels_.plan());
      // Without the rest of the levels the distance is not known.
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

  /// What the distance is bounded by; nothing where it is not.
  [[nodiscard]] std::optional<DistanceLimit> limit_to_explore() const {
    if (!bounds_distance()) return std::nullopt;
    if (selection_.camera() != nullptr) return limit(threshold_ / selection_.threshold());
    return DistanceLimit{.everywhere = threshold_ * selection_.diagonal()};
  }

  /// Those that are divided, and those at an outline.
  [[nodiscard]] Buffer<uint32_t> faces_to_divide() {
    LevelChoice& choice = choices_.back();
    Buffer<uint32_t> red = choice.region.faces;
    keep_if(red, [&](uint32_t f) { return choice.split_mask(f) == 7; });
    if (selection_.follows_outline()) add_faces_at_outline(choice, selection_, red);
    return red;
  }

  /// Splits further edges until the result is within the tolerance of the uniform surface, as far as budget and limits
  /// allow. Returns whether any was split.
  bool repair(int& level) {
    Repair repair(choices_, selection_.threshold(), most_cosine_, allowed(share_of_tolerance), options_.levels,
                  progress_);
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
    has_repaired_ = has_repaired;
    return has_repaired;
  }

  /// That of limit().
  [[nodiscard]] AllowedDistance allowed(double share) const {
    if (selection_.camera() == nullptr) return AllowedDistance(limit(share).everywhere);
    return {choices_, limit(share)};
  }

  /// Whether the result may be as large as it is now.
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
    return assemble(choices_, most_cosine_, options_.edges || options_.simplify_hidden,
                    displacements_of(choices_, options_));
  }

  [[nodiscard]] const Mesh& coarse() const { return choices_[0].level->mesh; }
  [[nodiscard]] bool has_detail() const { return coarse().detail != nullptr; }
  [[nodiscard]] bool is_uniform() const {
    const uint64_t coarse = choices_[0].region.faces.size();
    return count_assembled(choices_) == coarse << (2 * static_cast<uint64_t>(options_.levels));
  }

  /// Upper bound of the distance from the uniform surface.
  [[nodiscard]] double distance() const {
    if (has_detail() && is_uniform()) return 0;
    const double limit_kept = limit(share_of_tolerance).everywhere;
    if (is_within_limit_ && has_repaired_) return limit_kept;
    const double found = surface_check(AllowedDistance(1)).largest_share();
    return is_within_limit_ && has_detail() ? std::min(found, limit_kept) : found;
  }

  /// The same in pixels, of what the view shows.
  [[nodiscard]] double distance_in_pixels() const {
    if (has_detail() && is_uniform()) return 0;
    const SurfaceCheck check = surface_check(allowed(1));
    return options_.view->error_pixels *
           (is_within_limit_ ? std::min(check.largest_bound(), share_of_tolerance) : check.largest_share());
  }

  [[nodiscard]] SurfaceCheck surface_check(AllowedDistance allowed) const {
    return {choices_, most_cosine_, options_.levels, std::move(allowed), 0, progress_};
  }

  void finish(Result& result, Mesh latest) {
    bring_back_what_was_kept();
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
    if (progress_.wants_levels())
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
  double most_cosine_;                ///< what transition faces keep to
  float threshold_;
  Splits kept_;  ///< [level] the edges split when a level last changed something
  Exploration exploration_;
  bool is_within_limit_ = false;  ///< of the surface, as repair() found; which may have split more
  bool has_repaired_ = false;
  bool out_of_budget_ = false;
  bool is_at_limit_ = false;
};

}  // namespace

Result refine_red_green(Levels levels, const Options& options, const Selection& selection, const Progress& progress) {
  return RedGreen(std::move(levels), options, selection, progress).run();
}

}  // namespace papilio
