#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Coarse mesh whose vertices are some of the original's.
struct BaseMesh {
  TriangleMesh triangles;
  std::vector<uint32_t> vertex;                ///< [V] number in the original
  std::vector<uint32_t> face;                  ///< [F] number in the sequence, whose corners are in the same order
  std::vector<std::array<bool, 3>> is_crease;  ///< [F] whether the side from each corner to the next is one
  std::vector<bool> is_corner;                 ///< [V] whether boundaries and creases end there
  std::vector<Triangle> point;                 ///< [F] points of the original's attributes; empty: there are none
  size_t collapses = 0;                        ///< of the sequence that led to it
};

/// Simplification of a manifold by collapses of edges onto one of their ends, which remembers how the surfaces
/// correspond: each collapse unfolds the faces round the removed vertex into the plane, where they cover the same
/// polygon before and after. A place on the base is lifted to the original through these polygons, collapse by
/// collapse: a bijection [Lee et al., "MAPS", 1998; Liu et al., "Neural Subdivision", 2020].
///
/// Vertices on boundaries, creases and seams of attributes move along them, and corners stay (sharp_curves.h), as do
/// vertices at which seams end or meet. So curves and seams of the base correspond to those of the original.
///
/// Collapses are chosen by quadrics weighted by area [Garland, Heckbert 1997] and by the shape of the faces that they
/// make. Those that change the topology, turn a face over or have no valid unfolding are refused.
class CollapseSequence {
 public:
  /// `original` must be manifold, with edges. `weight` [V] scales quadrics and shapes at a vertex; empty: 1.
  explicit CollapseSequence(const Mesh& original, std::vector<float> weight = {});
  ~CollapseSequence();
  CollapseSequence(const CollapseSequence&) = delete;
  CollapseSequence& operator=(const CollapseSequence&) = delete;

  /// Collapses until at most `faces` are left or nothing can be collapsed. `poll` is called every few thousand
  /// collapses and may throw to stop. O(log V) a collapse.
  void collapse_to(uint32_t faces, const std::function<void()>& poll = {});
  [[nodiscard]] BaseMesh base() const;

  /// Moves places on a base, as numbers in the sequence, to the original. O(log(V)) a place.
  void lift(std::vector<SurfacePlace>& places, const BaseMesh& base, const std::function<void()>& poll = {}) const;

 private:
  class Collapser;
  std::unique_ptr<Collapser> collapser_;
};

}  // namespace papilio
