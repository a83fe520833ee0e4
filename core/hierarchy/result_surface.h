#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hierarchy/level_choice.h"
#include "papilio/triangle_distance.h"

// Result of a choice as a surface: the undivided faces of its levels, each whole or in pieces.

namespace papilio {

using Corners = std::array<Vec3d, 3>;  ///< of a face; or the middles of its sides, side i running from corner i

[[nodiscard]] Corners corners_of(const LevelChoice& choice, FaceId face);
/// Returns the new vertices of the face's edges; the middles of edges without one. `corner`: see corners_of().
[[nodiscard]] Corners new_vertices_of(const LevelChoice& choice, FaceId face, const Corners& corner);

/// Face of a level.
struct LevelFace {
  uint32_t level, face;
  friend bool operator==(const LevelFace&, const LevelFace&) = default;
};

/// Surface of the result that assemble() makes of the levels. Not thread-safe.
class ResultSurface {
 public:
  /// The levels must outlive this object.
  explicit ResultSurface(std::span<const LevelChoice> levels) : levels_(levels) {}

  [[nodiscard]] const LevelChoice& choice(uint32_t k) const { return levels_[k]; }
  [[nodiscard]] const HierarchyLevel& level(uint32_t k) const { return *levels_[k].level; }
  [[nodiscard]] const Topology& topology(uint32_t k) const { return level(k).mesh.topology; }
  [[nodiscard]] Corners corners(uint32_t k, FaceId f) const { return corners_of(levels_[k], f); }
  [[nodiscard]] Corners new_vertices(uint32_t k, FaceId f, const Corners& corner) const {
    return new_vertices_of(levels_[k], f, corner);
  }

  /// Returns whether the face has children in the region of the next level.
  [[nodiscard]] bool has_children(uint32_t k, FaceId f) const {
    return k + 1 < levels_.size() && levels_[k].red[f] != 0;
  }
  [[nodiscard]] uint32_t first_child(uint32_t k, FaceId f) const { return level(k + 1).first_child_of(f); }
  /// Returns whether the result has the face's children in its place.
  [[nodiscard]] bool is_divided(uint32_t k, FaceId f) const {
    return has_children(k, f) && levels_[k].split_mask(f) == 7;
  }
  /// Returns whether a transition face with two split edges is cut along the second diagonal.
  [[nodiscard]] bool has_second_diagonal(uint32_t k, FaceId f, unsigned mask) const;

  /// Replaces `pieces` by the pieces of an undivided face.
  void find_pieces(const LevelFace& leaf, std::vector<TriangleCorners>& pieces) const;
  /// Replaces `beside` by the undivided faces across side i of `leaf`. Neighbours differ by one level at most.
  void find_beside(const LevelFace& leaf, uint32_t i, std::vector<LevelFace>& beside) const;

  /// Returns the squared distance from a point to the result around an undivided face. Visits neighbours while they are
  /// as near as any face so far, and the distance is above `enough`. `nearest`, unless null, gets the piece.
  [[nodiscard]] double squared_distance_from(const LevelFace& leaf, Vec3d point, double enough,
                                             TriangleCorners* nearest = nullptr);

 private:
  /// Returns the face across side i of a face, of its level or, if not held there, of the level above.
  [[nodiscard]] LevelFace face_across(uint32_t k, FaceId f, uint32_t i) const;
  [[nodiscard]] double squared_distance_to_leaf(const LevelFace& leaf, Vec3d point, double enough,
                                                TriangleCorners& nearest);

  std::span<const LevelChoice> levels_;
  std::vector<LevelFace> visited_, beside_;  ///< members to reuse their memory
  std::vector<TriangleCorners> pieces_;      ///< member to reuse its memory
};

}  // namespace papilio
