#include "levels.h"

#include <algorithm>
#include <numeric>

#include "attributes.h"
#include "grow_level.h"
#include "part.h"
#include "transition.h"

namespace papilio {
namespace {

/// Of a level that is kept: about the sum of its arrays. What is kept in the end is counted to the byte.
constexpr uint64_t bytes_per_kept_face = 122;
constexpr uint64_t bytes_per_face = 160;  ///< at most, of a level's arrays and of what is computed on it
/// All of a level costs about as much as so large a part of it.
constexpr double part_as_dear_as_all = 0.75;
/// Where a level is kept, later views are likely to ask for the rest of it: then all of it is made earlier.
constexpr double part_as_dear_as_all_kept = 1.0 / 3;

/// The fours of a level's faces whose parents are red.
List<uint32_t> fours_below_red(const HierarchyLevel& level) {
  List<uint32_t> fours(level.parent.size());
  std::iota(fours.begin(), fours.end(), 0U);
  keep_if(fours, [&](uint32_t i) { return level.parent[i] != none && level.red[level.parent[i]] != 0; });
  return fours;
}

bool covers(const List<uint8_t>& known, const List<uint8_t>& red) {
  return std::ranges::equal(known, red, [](uint8_t has, uint8_t wants) { return has >= wants; });
}

}  // namespace

Levels::Levels(Mesh coarse, const Options& options, const Progress& progress)
    : options_(options), progress_(progress), smallest_angle_(papilio::smallest_angle(coarse)) {
  auto level = std::make_shared<HierarchyLevel>(coarsest_level(std::move(coarse)));
  progress_.poll();
  if (options.view) level->longest = longest_edges(level->mesh);
  const TrialContext context{.features = &level->features, .threads = progress.threads()};
  level->trial = options.w == 0 ? try_everything(level->mesh, options, context)
                                : try_split(level->mesh, options, complete_edges(*level), context);
  level->trial.prepare_errors(level->mesh, options, context);
  levels_.push_back(std::move(level));
}

Levels::Levels(const PreparedMesh& prepared, const Options& options, const Progress& progress)
    : options_(options),
      progress_(progress),
      prepared_(&prepared),
      known_(prepared.kept()),
      levels_{known_[0]},
      to_keep_(1),
      smallest_angle_(prepared.smallest_angle_) {}

void Levels::deepen(const List<uint8_t>& red) {
  const size_t depth = levels_.size();
  if (depth < known_.size()) {
    const std::shared_ptr<const HierarchyLevel> known = known_[depth];
    if (moved_.empty() && covers(known->red, red)) {
      levels_.push_back(known);
      ++to_keep_;
      return;
    }
    if (make_with_known(*known, with_margin(red)) || make_with_known(*known, red)) return;
    known_.resize(depth);  // this one takes its place
  }
  make(red);
}

bool Levels::make_with_known(const HierarchyLevel& known, List<uint8_t> red) {
  for (uint32_t f = 0; f < known.red.size(); ++f)
    if (known.red[f] != 0) red[moved_.empty() ? f : moved_[f]] = 1;
  if (!may_keep(red)) return false;
  LevelBelow below = refine_level(*levels_.back(), std::move(red), progress_.threads());
  const auto level = std::make_shared<HierarchyLevel>(std::move(below.level));
  List<uint32_t> moved(known.mesh.topology.face_count());
  for (uint32_t f = 0; f < moved.size(); ++f) {
    const uint32_t parent = known.parent_of(f);
    moved[f] = level->first_child_of(moved_.empty() ? parent : moved_[parent]) + f % 4;
  }
  moved_ = std::move(moved);
  progress_.poll();
  level->longest = longest_edges_below(parents_of(*level, below.parents), level->mesh.positions);
  try_grown_level(*level, options_, known, moved_);
  add_kept(level);
  return true;
}

List<uint8_t> Levels::with_margin(const List<uint8_t>& red) const {
  const HierarchyLevel& level = *levels_.back();
  const Topology& mesh = level.mesh.topology;
  List<uint8_t> wide = with_neighbours(mesh, red);
  if (levels_.size() == 1) return wide;
  const EdgeMarks may_split = edges_below_red(level);
  for (uint32_t f = 0; f < wide.size(); ++f) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    if (red[f] == 0 && (may_split[edge[0]] & may_split[edge[1]] & may_split[edge[2]]) == 0) wide[f] = 0;
  }
  return wide;
}

bool Levels::may_keep(const List<uint8_t>& red) const {
  if (prepared_ == nullptr || to_keep_ < levels_.size()) return false;
  const List<uint8_t> support = with_neighbours(levels_.back()->mesh.topology, red);
  uint64_t bytes = 4 * bytes_per_kept_face * static_cast<uint64_t>(std::ranges::count(support, 1));
  for (const auto& level : levels_) bytes += level->bytes();
  return bytes <= prepared_->budget_;
}

List<uint8_t> Levels::or_everything(List<uint8_t> red, double as_dear) const {
  if (costs_as_much_as_all(with_neighbours(levels_.back()->mesh.topology, red), as_dear)) red.assign(red.size(), 1);
  return red;
}

bool Levels::costs_as_much_as_all(const List<uint8_t>& held, double as_dear) const {
  const HierarchyLevel& level = *levels_.back();
  return level.is_whole && level.trial.made.size() == level.mesh.topology.edge_count() &&
         progress_.has_plenty(4 * held.size(), bytes_per_face) &&
         static_cast<double>(std::ranges::count(held, 1)) >= as_dear * static_cast<double>(held.size());
}

void Levels::make(const List<uint8_t>& red) {
  if (prepared_ != nullptr && to_keep_ == levels_.size()) {
    List<uint8_t> more = or_everything(with_margin(red), part_as_dear_as_all_kept);
    if (!may_keep(more)) more = or_everything(red, part_as_dear_as_all);
    if (may_keep(more)) {
      make_to_keep(std::move(more));
      return;
    }
  }
  const bool in_part = may_be_made_in_part();
  if (in_part && is_next_last()) {
    make_in_part(red, Part(levels_.back()->mesh.topology, red));
    return;
  }
  const List<uint8_t> support = with_neighbours(levels_.back()->mesh.topology, red);
  if (costs_as_much_as_all(support, part_as_dear_as_all))
    make_for_once(List<uint8_t>(red.size(), 1));
  else if (in_part)
    make_in_part(red, Part(levels_.back()->mesh.topology, support));
  else
    make_for_once(red);
}

void Levels::make_to_keep(List<uint8_t> red) {
  LevelBelow below = refine_level(*levels_.back(), std::move(red), progress_.threads());
  const auto level = std::make_shared<HierarchyLevel>(std::move(below.level));
  progress_.poll();
  const Topology& parents = parents_of(*level, below.parents);
  level->longest = longest_edges_below(parents, level->mesh.positions);
  TrialContext context{.features = &level->features, .threads = progress_.threads()};
  if (level->is_whole) context.parents = &parents;
  level->trial = try_split(level->mesh, options_, complete_edges(*level), context);
  level->trial.keep_more(level->mesh.topology);
  add_kept(level);
}

void Levels::make_for_once(List<uint8_t> red) {
  LevelBelow below = refine_level(*levels_.back(), std::move(red), progress_.threads());
  const auto level = std::make_shared<HierarchyLevel>(std::move(below.level));
  progress_.poll();
  const Topology& parents = parents_of(*level, below.parents);
  if (options_.view) level->longest = longest_edges_below(parents, level->mesh.positions);
  try_for_once(*level, parents);
  levels_.push_back(level);
}

bool Levels::may_be_made_in_part() const {
  const HierarchyLevel& above = *levels_.back();
  const bool has_no_cuts = above.is_whole || above.complete.empty() || is_next_last();  // of faces that get children
  return has_no_cuts && options_.tension == Tension::off && options_.w == 0 && above.features.are_rings() &&
         above.trial.made.size() == above.mesh.topology.edge_count();
}

void Levels::make_in_part(const List<uint8_t>& red, const Part& part) {
  const HierarchyLevel& above = *levels_.back();
  const Topology& parents = above.mesh.topology;
  const auto level = std::make_shared<HierarchyLevel>(refine_in_part(above, red, part, progress_.threads()));
  progress_.poll();
  if (options_.view) {
    const List<uint32_t> round_them = marked(with_neighbours(parents, red));
    level->longest = longest_edges_below(parents, level->mesh.positions, &round_them);
  }
  const List<uint32_t> fours = fours_below_red(*level);
  const TrialContext context{.features = &level->features,
                             .parents = &parents,
                             .normals_of = &fours,
                             .part = &part,
                             .threads = progress_.threads()};
  level->trial = try_everything(level->mesh, options_, context);
  level->trial.prepare_errors(level->mesh, options_, context);
  levels_.push_back(level);
}

bool Levels::is_next_last() const { return static_cast<int>(levels_.size()) + 1 >= options_.levels; }

const Topology& Levels::parents_of(const HierarchyLevel& level, const Topology& held) const {
  return level.is_whole ? levels_.back()->mesh.topology : held;
}

void Levels::try_for_once(HierarchyLevel& level, const Topology& parents) const {
  constexpr size_t one_as_dear_as = 4;  // of all, family by family
  TrialContext context{.features = &level.features, .parents = &parents, .threads = progress_.threads()};
  List<uint32_t> below_red;
  bool are_few = false;
  if (!level.is_whole) {
    below_red = fours_below_red(level);
    context.normals_of = &below_red;
  }
  if (is_next_last() && !level.is_whole) {
    are_few = one_as_dear_as * below_red.size() < level.parent.size();
    context.asked_of = &below_red;
  }
  if (are_few || options_.w != 0)
    level.trial = try_split(level.mesh, options_,
                            context.asked_of == nullptr ? complete_edges(level) : edges_below_red(level), context);
  else
    level.trial = try_everything(level.mesh, options_, context);
  level.trial.prepare_errors(level.mesh, options_, context);
}

void Levels::add_kept(std::shared_ptr<const HierarchyLevel> level) {
  levels_.push_back(std::move(level));
  ++to_keep_;
  has_grown_ = true;
}

void Levels::hand_back() {
  if (!has_grown_) return;
  while (!moved_.empty() && levels_.size() < known_.size())
    if (!make_with_known(*known_[levels_.size()], List<uint8_t>(levels_.back()->mesh.topology.face_count(), 0))) break;
  levels_.resize(to_keep_);
  prepared_->keep(std::move(levels_));
}

}  // namespace papilio
