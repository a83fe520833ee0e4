#pragma once

#include <memory>
#include <vector>

#include "hierarchy/hierarchy.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/prepared_state.h"
#include "hierarchy/progress.h"

namespace papilio {

/// The levels of the hierarchy that one request works on: made for it alone, or shared with others through a prepared
/// mesh.
class Levels {
 public:
  /// Made for this request: no more than it needs is computed. Level 0 is there and tried. Throws `Error` cancelled.
  Levels(Mesh coarse, const Options& options, const Progress& progress);
  /// Those of a prepared mesh, which must outlive this.
  Levels(const PreparedMesh& prepared, const Options& options, const Progress& progress);

  [[nodiscard]] const MemoryPlan& plan() const { return plan_; }
  [[nodiscard]] const std::shared_ptr<const HierarchyLevel>& deepest() const { return levels_.back(); }
  /// Of the coarse mesh, in radians.
  [[nodiscard]] double smallest_angle() const { return smallest_angle_; }

  /// Adds a level that holds the children of the deepest one's faces marked `red` [F], and maybe others; its edges are
  /// tried. Throws `Error` cancelled.
  void deepen(const Buffer<uint8_t>& red);

  /// Gives what was made to the prepared mesh, if there is one.
  void hand_back();

 private:
  /// Adds a level for the children of these faces and of all that the known level of its depth has; false, and nothing
  /// is done, where that is more than may be kept.
  bool make_with_known(const HierarchyLevel& known, Buffer<uint8_t> red);
  [[nodiscard]] bool may_keep(const Buffer<uint8_t>& red) const;
  /// The faces of the deepest level marked `red` [F] and those round them that may have children too: with them the
  /// next view, from a little further on, finds what it needs.
  [[nodiscard]] Buffer<uint8_t> with_margin(const Buffer<uint8_t>& red) const;
  /// All faces of the deepest level if it is whole and so large a part of them would be held: then all cost less. Else
  /// those marked.
  [[nodiscard]] Buffer<uint8_t> or_everything(Buffer<uint8_t> red, double as_dear) const;
  void make(const Buffer<uint8_t>& red);
  /// Whether a level is held for later requests too, or for this one alone, of which then no more is tried than this
  /// request may ask for.
  enum class Retention { kept, for_once };
  /// Adds a level that holds the children of the deepest one's faces marked `red` [F] and of those round them; all of
  /// it where that costs less, and where nothing will lie below and it is for once, `red` alone (refine_last_level).
  void add_level(Buffer<uint8_t> red, Retention retention);
  /// Whether that last is possible for the plain rules.
  [[nodiscard]] bool may_hold_red_alone() const;
  /// Whether the limits allow all of the next level.
  [[nodiscard]] bool has_room_for_whole() const;
  /// Whether no level will lie below the one below the deepest.
  [[nodiscard]] bool is_next_last() const;

  const Options& options_;
  const Progress& progress_;
  const PreparedMesh::State* prepared_ = nullptr;
  KeptLevels known_;   ///< what was kept when the request began
  KeptLevels levels_;  ///< what it works on
  MemoryPlan plan_;
  size_t to_keep_ = 0;      ///< how many of these may be kept
  bool has_grown_ = false;  ///< one of those was made
  /// Where the deepest level is made of more than the known one of its depth: [F of the known] the same face in it.
  Buffer<uint32_t> moved_;
  double smallest_angle_;
};

}  // namespace papilio
