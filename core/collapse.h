#pragma once

#include <cstdint>
#include <vector>

#include "mesh.h"

namespace papilio {

/// What edge collapses onto existing vertices made of a mesh.
struct Collapsed {
  Mesh mesh;                     ///< without creases and darts
  std::vector<uint32_t> vertex;  ///< [V] number of each vertex in the mesh before, ascending
};

/// The points [H] at the corners, or the vertices when there are no attributes: what meshoptimizer calls vertices.
[[nodiscard]] const Array<uint32_t>& corner_points(const Mesh& mesh);

/// Collapses edges by meshoptimizer, which does not look after topology: the result is to be checked. (Nor does 0.18
/// avoid faces without area: they are mended where that can be done.) May be asked again and again; refers to the mesh.
class Collapser {
 public:
  /// Works on the `chosen` [F] faces.
  Collapser(const Mesh& mesh, const std::vector<bool>& chosen);

  /// Up to `error`, a share of the bounding box's diagonal. `locked` [V] stay: there have to be all vertices of faces
  /// that were not chosen, and all at seams and curves.
  [[nodiscard]] Collapsed run(const std::vector<bool>& locked, double error) const;

 private:
  [[nodiscard]] Array<Vec3f> place(const std::vector<bool>& locked) const;
  [[nodiscard]] Collapsed assemble(Array<uint32_t> points) const;

  const Mesh& mesh_;
  std::vector<uint32_t> vertex_of_point_;
  std::vector<uint32_t> fixed_, chosen_;  ///< corners of the faces, as points
  Box box_;
  double scale_;  ///< a power of two that brings the box's longest side below 1
};

}  // namespace papilio
