#pragma once

#include <array>

#include "papilio/mesh.h"

// What the deviations of many edges (deviation.h) are at least and at most, at a fraction of their cost: enough to tell
// most of them from a tolerance.

namespace papilio {

/// For each face [F] how far the other two sides are at least from the middle of each side; 0 where the face is too
/// narrow for that to be certain. In the mesh's unit. Where faces come by fours (split_in_four.h), only some may be
/// asked about, by number; the others mean nothing then. Up to so many threads work on it.
[[nodiscard]] Buffer<float> rooms_at_sides(const Mesh& mesh, const Buffer<uint32_t>* fours, int threads);

struct DeviationRange {
  float least, most;
};

/// What is known of a mesh and the new vertices of its edges: all must outlive this.
struct DeviationBounds {
  const Mesh& mesh;
  const Buffer<Vec3f>& normals;  ///< [F], of faces that have room
  const Buffer<float>& rooms;    ///< [F] as above
  const Buffer<Vec3f>& made;     ///< [E]

  /// The ranges of four edges, which were tried. Mostly both ends are within a few millionths of how far the vertex is
  /// from the midpoint. Where the deviation is not found easily they are 0 and all of that.
  [[nodiscard]] std::array<DeviationRange, 4> find(const std::array<uint32_t, 4>& edges) const;
};

}  // namespace papilio
