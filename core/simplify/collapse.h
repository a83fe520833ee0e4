#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Result of edge collapses onto existing vertices of a mesh.
struct Collapsed {
  Mesh mesh;                     ///< without creases and darts
  std::vector<uint32_t> vertex;  ///< [V] number of each vertex in the mesh before, ascending
};

/// Edge collapse by meshoptimizer. It does not preserve topology: the result must be checked (simplify_check.h).
/// Version 0.18 also makes faces without area, which are repaired where possible (flip_slivers.h). Refers to the mesh;
/// may run repeatedly.
///
/// meshoptimizer cannot be stopped, and takes time quadratic in the valence. So the surface is divided into parts with
/// locked vertices near their borders, and faces at vertices of high valence are kept.
class Collapser {
 public:
  static constexpr uint32_t most_faces = 1 << 16;           ///< upper bound of the faces of a part
  static constexpr uint32_t most_faces_at_vertex = 1 << 8;  ///< upper bound of chosen faces at a vertex to be collapsed

  /// Prepares the `chosen` [F] faces. `poll` is called between parts; it may throw to stop.
  Collapser(const Mesh& mesh, const std::vector<bool>& chosen, std::function<void()> poll);

  /// Collapses up to `error`, a share of the bounding box's diagonal. Keeps `locked` [V] vertices, which must include
  /// all vertices of faces that were not chosen, and all on seams and curves.
  [[nodiscard]] Collapsed run(const std::vector<bool>& locked, double error) const;

 private:
  using Corners = std::vector<uint32_t>;  ///< corners of faces, as points
  void set_aside(const std::vector<bool>& chosen, std::vector<bool>& to_collapse);
  void split_into_parts(std::vector<bool> to_collapse);
  void lock_borders();
  void collapse(const Corners& part, const std::vector<bool>& locked, double error, Buffer<uint32_t>& out) const;
  [[nodiscard]] Buffer<Vec3f> place(const std::vector<uint32_t>& points, const std::vector<bool>& locked) const;
  [[nodiscard]] Collapsed assemble(Buffer<uint32_t> points) const;

  const Mesh& mesh_;
  std::function<void()> poll_;
  std::vector<uint32_t> vertex_of_point_;
  Corners fixed_;  ///< corners of faces that were not chosen, then of chosen faces that are kept
  std::vector<Corners> parts_;
  std::vector<bool> is_locked_;  ///< [V] vertices locked in addition to the caller's
  Box box_;
  double scale_;  ///< power of two that scales the box's longest side below 1
};

}  // namespace papilio
