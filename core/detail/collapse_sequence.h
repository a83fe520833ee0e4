#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/poller.h"
#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Coarse mesh whose vertices are some of the original's.
struct BaseMesh {
  TriangleMesh triangles;
  std::vector<uint32_t> vertex;                ///< [V] number in the original
  std::vector<uint32_t> face;                  ///< [F] number in the sequence; corners are in the sequence's order
  std::vector<std::array<bool, 3>> is_crease;  ///< [F] whether the side from each corner to the next is a crease
  std::vector<bool> is_corner;                 ///< [V] whether boundaries and creases end at the vertex
  std::vector<Triangle> point;                 ///< [F] points of the original's attributes; empty without attributes
  size_t collapses = 0;                        ///< number of the sequence's collapses that made the mesh
};

/// Simplification of a manifold by edge collapses onto one end, with the correspondence of surfaces. Each collapse
/// unfolds the faces round the removed vertex into the plane, where they cover one polygon before and after. A place on
/// the base is lifted to the original through these polygons, collapse by collapse. The map is a bijection [Lee et al.,
/// "MAPS", 1998; Liu et al., "Neural Subdivision", 2020].
///
/// Vertices on boundaries, creases and seams of attributes move along them. Corners (sharp_curves.h) and vertices at
/// which seams end or meet are kept. So curves and seams of the base correspond to those of the original.
///
/// Collapses are chosen by area-weighted quadrics [Garland, Heckbert 1997] and by the shape of the new faces. Collapses
/// that change the topology, turn a face over or have no valid unfolding are refused.
class CollapseSequence {
 public:
  /// Starts at `original`, which must be manifold, with edges. `weight` [V] scales quadrics and shape costs at a
  /// vertex; empty: 1. O(V log V).
  explicit CollapseSequence(const Mesh& original, std::vector<float> weight = {}, const Poller& poller = {});
  ~CollapseSequence();
  CollapseSequence(const CollapseSequence&) = delete;
  CollapseSequence& operator=(const CollapseSequence&) = delete;

  /// Collapses until at most `faces` are left or nothing can be collapsed. O(log V) a collapse.
  void collapse_to(uint32_t faces, const Poller& poller = {});
  [[nodiscard]] BaseMesh base() const;

  /// Moves places on a base to the original; faces are numbers in the sequence. O(log V) a place.
  void lift(std::vector<SurfacePlace>& places, const BaseMesh& base, const Poller& poller = {}) const;

 private:
  class Collapser;
  std::unique_ptr<Collapser> collapser_;
};

}  // namespace papilio
