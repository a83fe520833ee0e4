#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hierarchy/level_choice.h"
#include "papilio/triangle_distance.h"

// The result of a choice as a surface: the undivided faces of its levels, each whole or in pieces.

namespace papilio {

using Corners = std::array<Vec3d, 3>;  ///< of a face; or the middles of its sides, side i running from corner i

[[nodiscard]] Corners corners_of(const LevelChoice& choice, uint32_t face);
/// The new vertices of the face's edges; the middle where none was computed. `corner` as above.
[[nodiscard]] Corners new_vertices_of(const LevelChoice& choice, uint32_t face, const Corners& corner);

/// A face of a level.
struct LevelFace {
  uint32_t level, face;
  friend bool operator==(const LevelFace&, const LevelFace&) = default;
};

/// Questions about the result that assemble() makes of the levels. Not for threads to share.
class ResultSurface {
 public:
  /// The levels must outlive this. `most_cosine`: see transition.h.
  ResultSurface(std::span<const LevelChoice> levels, double most_cosine) : levels_(levels), most_cosine_(most_cosine) {}

  [[nodiscard]] const LevelChoice& choice(uint32_t k) const { return levels_[k]; }
  [[nodiscard]] const HierarchyLevel& level(uint32_t k) const { return *levels_[k].level; }
  [[nodiscard]] const Topology& topology(uint32_t k) const { return level(k).mesh.topology; }
  [[nodiscard]] Corners corners(uint32_t k, uint32_t f) const { return corners_of(levels_[k], f); }
  [[nodiscard]] Corners new_vertices(uint32_t k, uint32_t f, const Corners& corner) const {
    return new_vertices_of(levels_[k], f, corner);
  }

  /// Whether the face has children in the region of the next level.
  [[nodiscard]] bool has_children(uint32_t k, uint32_t f) const {
    return k + 1 < levels_.size() && levels_[k].red[f] != 0;
  }
  [[nodiscard]] uint32_t first_child(uint32_t k, uint32_t f) const { return level(k + 1).first_child_of(f); }
  /// Whether the result has the face's children in its place.
  [[nodiscard]] bool is_divided(uint32_t k, uint32_t f) const {
    return has_children(k, f) && levels_[k].split_mask(f) == 7;
  }
  /// Whether a transition face with two split edges is cut along the second diagonal.
  [[nodiscard]] bool has_second_diagonal(uint32_t k, uint32_t f, unsigned mask) const;

  /// Replaces `pieces` by those of an undivided face.
  void find_pieces(const LevelFace& leaf, std::vector<TriangleCorners>& pieces) const;
  /// Replaces `beside` by the undivided faces across side i of one. Neighbours differ by one level at most.
  void find_beside(const LevelFace& leaf, uint32_t i, std::vector<LevelFace>& beside) const;

  /// The distance, squared, from a point to the result round an undivided face: visits others as long as they are as
  /// near as any so far, and the distance is above `enough`.
  [[nodiscard]] double squared_distance_from(const LevelFace& leaf, Vec3d point, double enough);

 private:
  /// The face across side i of a face, of its level or, where that does not hold it, of the one above.
  [[nodiscard]] LevelFace face_across(uint32_t k, uint32_t f, uint32_t i) const;
  [[nodiscard]] double squared_distance_to_leaf(const LevelFace& leaf, Vec3d point, double enough);

  std::span<const LevelChoice> levels_;
  double most_cosine_;
  std::vector<LevelFace> visited_, beside_;  ///< as below: kept for their memory
  std::vector<TriangleCorners> pieces_;
};

}  // namespace papilio
