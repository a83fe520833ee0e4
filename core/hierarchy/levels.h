#pragma once

#include <memory>
#include <vector>

#include "hierarchy/hierarchy.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/prepared_state.h"
#include "hierarchy/progress.h"

namespace papilio {

/// Levels of the hierarchy that one request uses: made for it alone, or shared through a prepared mesh.
///
/// A level may hold more than the request needs, for the next request: the margin round the faces of a view, all that
/// an earlier request needed (`known_`), or the whole level where that costs as much. How much is held never changes a
/// result.
class Levels {
 public:
  /// Makes levels for this request: only required values are computed. Level 0 exists and is tried. Throws
  /// `Error` cancelled.
  Levels(Mesh coarse, const Options& options, const Progress& progress);
  /// Uses the levels of a prepared mesh, which must outlive this object.
  Levels(const PreparedMesh& prepared, const Options& options, const Progress& progress);

  [[nodiscard]] const MemoryPlan& plan() const { return plan_; }
  [[nodiscard]] const std::shared_ptr<const HierarchyLevel>& deepest() const { return levels_.back(); }

  /// Adds a level that holds the children of the deepest level's faces marked `red` [F], and perhaps others; its edges
  /// are tried. Throws `Error` cancelled.
  void deepen(const Buffer<uint8_t>& red);

  /// Stores the levels made in the prepared mesh, if there is one.
  void hand_back();

 private:
  /// Adds a level for the children of `red` and of all faces with children in the known level of its depth. Returns
  /// false, and does nothing, if that exceeds the memory to be kept.
  bool make_with_known(const HierarchyLevel& known, Buffer<uint8_t> red);
  [[nodiscard]] bool may_keep(const Buffer<uint8_t>& red) const;
  /// Returns the faces of the deepest level marked `red` [F] and their neighbours that may have children too. The
  /// margin serves the next view, from a slightly different position.
  [[nodiscard]] Buffer<uint8_t> with_margin(const Buffer<uint8_t>& red) const;
  /// Returns all faces of the deepest level if it is whole, there is room, and at least a share `least_share` of it
  /// would be held. Otherwise returns `red`.
  [[nodiscard]] Buffer<uint8_t> or_whole_level(Buffer<uint8_t> red, double least_share) const;
  void make(const Buffer<uint8_t>& red);
  /// Lifetime of a level: kept for later requests, or for this one alone.
  enum class Retention { kept, for_once };
  /// Adds a level that holds the children of the deepest level's faces marked `red` [F] and of their neighbours. If it
  /// is the last and not kept, it may hold `red` alone (refine_last_level).
  void add_level(Buffer<uint8_t> red, Retention retention);
  /// Returns whether new vertices are those of the published scheme.
  [[nodiscard]] bool is_plain() const { return options_.tension == Tension::off && options_.w == 0; }
  /// Returns whether the next level may hold `red` alone (refine_last_level).
  [[nodiscard]] bool may_hold_red_alone() const;
  /// Returns whether the limits allow all of the next level.
  [[nodiscard]] bool has_room_for_whole() const;

  const Options& options_;
  const Progress& progress_;
  const PreparedMesh::State* prepared_ = nullptr;
  KeptLevels known_;   ///< levels kept when the request began
  KeptLevels levels_;  ///< levels that the request uses
  MemoryPlan plan_;
  size_t to_keep_ = 0;      ///< number of `levels_` that may be kept
  bool has_grown_ = false;  ///< whether this request made one to be kept
  /// [F of the known level] number of the face in the deepest level, if that holds more than the known
  /// level of its depth.
  Buffer<uint32_t> moved_;
};

}  // namespace papilio
