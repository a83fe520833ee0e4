#pragma once

#include <gtest/gtest.h>

#include <unordered_map>
#include <vector>

#include "papilio/refine.h"

namespace papilio::test {

/// All levels of a uniform refinement, for comparison with red-green results: the faces of each level, and the pieces
/// into which one or two split edges cut them.
class UniformHierarchy {
 public:
  /// Ignores the options' criteria.
  UniformHierarchy(const Mesh& coarse, const Options& options);

  [[nodiscard]] const Mesh& finest() const { return finest_; }

  /// Returns whether each vertex of the mesh is bit-identical to a vertex of the finest level, each face is a face of a
  /// level or a piece of one, and faces that share an edge are at most one level apart.
  [[nodiscard]] ::testing::AssertionResult contains(const Mesh& mesh) const;

 private:
  void add_level(const Topology& mesh, int level, bool may_be_cut);

  struct Piece {
    Triangle corners;  ///< sorted
    int level;         ///< of the face that it is a piece of
    friend auto operator<=>(const Piece&, const Piece&) = default;
  };
  Mesh finest_;
  std::vector<Piece> pieces_;                           ///< sorted
  std::unordered_map<uint64_t, uint32_t> at_position_;  ///< hash of a position: the first vertex there
};

/// Returns the smallest angle of all faces, in radians.
[[nodiscard]] double smallest_angle(const Mesh& mesh);

}  // namespace papilio::test
