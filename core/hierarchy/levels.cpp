#include "hierarchy/levels.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "criteria/view_culling.h"
#include "hierarchy/detail_levels.h"
#include "mesh/attributes.h"
#include "mesh/displacement.h"

namespace papilio {
namespace {

/// Estimated bytes of a kept level per face: about the sum of its arrays. In the end, kept levels are
/// counted to the byte.
constexpr uint64_t bytes_per_kept_face = 102;
/// Share of a level's faces from which the whole level is built: it costs about as much.
constexpr double whole_level_share = 0.6;
/// Share of a kept level's faces from which the whole level is built: later views are likely to need the rest.
constexpr double whole_kept_level_share = 1.0 / 3;

/// Copies the deviations of a level of equal depth that holds less. `moved` [F of known]: number of the
/// face in the level.
void carry_deviations(const HierarchyLevel& known, const Buffer<uint32_t>& moved, const HierarchyLevel& level) {
  for (EdgeId e = 0; e < known.mesh.topology.edge_count(); ++e) {
    const HalfEdgeId h = known.mesh.topology.half_edge[e];
    const uint32_t at = level.mesh.topology.edge[3 * moved[h.face()] + h % 3];
    level.trial.deviations.put(at, known.trial.deviations.get(e));
    level.trial.bounds.put(at, known.trial.bounds.get(e));
  }
}

bool covers(const Buffer<uint8_t>& known, const Buffer<uint8_t>& red) {
  return std::ranges::equal(known, red,
                            [](uint8_t is_known, uint8_t is_requested) { return is_known >= is_requested; });
}

}  // namespace

Levels::Levels(Mesh coarse, const Options& options, const Progress& progress)
    : options_(options), progress_(progress), plan_(coarse, options) {
  auto level = std::make_shared<HierarchyLevel>(coarsest_level(std::move(coarse)));
  progress_.poll();
  if (options.view) level->longest = longest_edges(level->mesh);
  const TrialContext context{.features = &level->features, .threads = progress.threads()};
  level->trial = try_level(*level, level->mesh, options, context, progress.cancelled());
  if (is_by_error(options)) level->trial.forget();
  levels_.push_back(std::move(level));
}

Levels::Levels(const PreparedMesh& prepared, const Options& options, const Progress& progress)
    : options_(options),
      progress_(progress),
      prepared_(&prepared.state()),
      known_(prepared_->kept()),
      levels_{known_[0]},
      plan_(prepared.coarse(), options),
      to_keep_(1) {}

void Levels::deepen(const Buffer<uint8_t>& red) {
  const size_t depth = levels_.size();
  if (depth < known_.size()) {
    const std::shared_ptr<const HierarchyLevel> known = known_[depth];
    if (moved_.empty() && covers(known->red, red)) {
      levels_.push_back(known);
      ++to_keep_;
      return;
    }
    if (make_with_known(*known, with_margin(red)) || make_with_known(*known, red)) return;
    known_.resize(depth);  // the new level replaces it
  }
  make(red);
}

bool Levels::make_with_known(const HierarchyLevel& known, Buffer<uint8_t> red) {
  for (uint32_t f = 0; f < known.red.size(); ++f)
    if (known.red[f] != 0) red[moved_.empty() ? f : moved_[f]] = 1;
  if (!may_keep(red)) return false;
  add_level(std::move(red), Retention::kept);
  const HierarchyLevel& level = *levels_.back();
  Buffer<uint32_t> moved(known.mesh.topology.face_count());
  for (FaceId f = 0; f < moved.size(); ++f) {
    const uint32_t parent = known.parent_of(f);
    moved[f] = level.first_child_of(moved_.empty() ? parent : moved_[parent]) + f % 4;
  }
  moved_ = std::move(moved);
  carry_deviations(known, moved_, level);
  return true;
}

Buffer<uint8_t> Levels::with_margin(const Buffer<uint8_t>& red) const {
  const HierarchyLevel& level = *levels_.back();
  const Topology& mesh = level.mesh.topology;
  Buffer<uint8_t> wide = with_neighbours(mesh, red);
  if (levels_.size() == 1) return wide;
  const Marks may_split = edges_below_red(level);
  for (FaceId f = 0; f < wide.size(); ++f) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    if (red[f] == 0 && (may_split[edge[0]] & may_split[edge[1]] & may_split[edge[2]]) == 0) wide[f] = 0;
  }
  return wide;
}

bool Levels::may_keep(const Buffer<uint8_t>& red) const {
  if (prepared_ == nullptr || to_keep_ < levels_.size()) return false;
  const Buffer<uint8_t> support = with_neighbours(levels_.back()->mesh.topology, red);
  uint64_t bytes = 4 * bytes_per_kept_face * static_cast<uint64_t>(std::ranges::count(support, 1));
  for (const auto& level : levels_) bytes += level->bytes();
  return bytes <= prepared_->budget();
}

Buffer<uint8_t> Levels::or_whole_level(Buffer<uint8_t> red, double least_share) const {
  const HierarchyLevel& level = *levels_.back();
  if (!level.is_whole || !has_room_for_whole()) return red;
  const Buffer<uint8_t> support = with_neighbours(level.mesh.topology, red);
  const auto held = static_cast<double>(std::ranges::count(support, 1));
  if (held >= least_share * static_cast<double>(red.size())) red.assign(red.size(), 1);
  return red;
}

void Levels::make(const Buffer<uint8_t>& red) {
  if (prepared_ != nullptr) {
    Buffer<uint8_t> more = or_whole_level(with_margin(red), whole_kept_level_share);
    if (!may_keep(more)) more = or_whole_level(red, whole_level_share);
    if (may_keep(more)) return add_level(std::move(more), Retention::kept);
  }
  const bool may_be_whole = is_plain() && !may_hold_red_alone();
  add_level(may_be_whole ? or_whole_level(red, whole_level_share) : red, Retention::for_once);
}

void Levels::add_level(Buffer<uint8_t> red, Retention retention) {
  const HierarchyLevel& above = *levels_.back();
  const Topology& mesh = above.mesh.topology;
  const int threads = progress_.threads();
  const bool is_kept = retention == Retention::kept;

  LevelBelow below;
  std::optional<Part> part;
  if (!is_kept && may_hold_red_alone()) {
    part.emplace(mesh, red);
    below.level = refine_last_level(above, std::move(red), *part, threads);
  } else {
    below = refine_level(above, std::move(red), threads);
  }
  const auto level = std::make_shared<HierarchyLevel>(std::move(below.level));
  progress_.poll();

  const Topology& parents = level->is_whole || part ? mesh : below.parents;
  if (is_kept || options_.view) level->longest = longest_edges_below(parents, level->mesh.positions);
  const Marks complete = options_.w != 0 ? complete_edges(*level) : Marks{};
  const bool is_by_families = part || (level->is_whole && is_plain() && above.features.are_rings());
  const TrialContext context{.features = is_by_families ? &above.features : &level->features,
                             .parents = is_by_families ? &mesh : nullptr,
                             .part = part ? &*part : nullptr,
                             .complete = &complete,
                             .threads = threads};
  level->trial = try_level(*level, levels_[0]->mesh, options_, context, progress_.cancelled());
  if (is_kept)
    level->trial.keep();
  else if (is_by_error(options_))
    level->trial.forget();
  levels_.push_back(level);
  to_keep_ += is_kept ? 1 : 0;
  has_grown_ |= is_kept;
}

bool Levels::may_hold_red_alone() const {
  const bool is_next_last = static_cast<int>(levels_.size()) + 1 >= options_.levels;
  return is_plain() && is_next_last && levels_.back()->features.are_rings() &&
         !has_displacements(levels_[0]->mesh.attributes) && levels_.back()->detail_levels <= 1 && has_room_for_whole();
}

bool Levels::has_room_for_whole() const {
  const uint64_t faces = 4ULL * levels_.back()->mesh.topology.face_count();
  return progress_.has_room(faces, plan_.made(faces, static_cast<int>(levels_.size()), bytes_per_held_face));
}

void Levels::hand_back() {
  if (!has_grown_) return;
  while (!moved_.empty() && levels_.size() < known_.size())
    if (!make_with_known(*known_[levels_.size()], Buffer<uint8_t>(levels_.back()->mesh.topology.face_count(), 0)))
      break;
  levels_.resize(to_keep_);
  prepared_->keep(std::move(levels_));
}

}  // namespace papilio
