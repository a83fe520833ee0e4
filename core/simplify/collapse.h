#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// What edge collapses onto existing vertices made of a mesh.
struct Collapsed {
  Mesh mesh;                     ///< without creases and darts
  std::vector<uint32_t> vertex;  ///< [V] number of each vertex in the mesh before, ascending
};

/// Collapses edges by meshoptimizer, which does not look after topology: the result is to be checked. (Nor does 0.18
/// avoid faces without area: they are mended where that can be done.) May be asked again and again; refers to the mesh.
///
/// meshoptimizer cannot be stopped, and takes time quadratic in the valence. So it is given one part of the surface
/// after another, and faces at vertices with many are left as they are. Near the borders of parts vertices are locked.
class Collapser {
 public:
  static constexpr uint32_t most_faces = 1 << 16;           ///< of a part
  static constexpr uint32_t most_faces_at_vertex = 1 << 8;  ///< of those that are chosen

  /// Works on the `chosen` [F] faces. `poll` is called between parts; it may throw to stop.
  Collapser(const Mesh& mesh, const std::vector<bool>& chosen, std::function<void()> poll);

  /// Up to `error`, a share of the bounding box's diagonal. `locked` [V] stay: there have to be all vertices of faces
  /// that were not chosen, and all at seams and curves.
  [[nodiscard]] Collapsed run(const std::vector<bool>& locked, double error) const;

 private:
  using Corners = std::vector<uint32_t>;  ///< of faces, as points
  void set_aside(const std::vector<bool>& chosen, std::vector<bool>& to_collapse);
  void split_into_parts(std::vector<bool> to_collapse);
  void lock_borders();
  void collapse(const Corners& part, const std::vector<bool>& locked, double error, Buffer<uint32_t>& out) const;
  [[nodiscard]] Buffer<Vec3f> place(const std::vector<uint32_t>& points, const std::vector<bool>& locked) const;
  [[nodiscard]] Collapsed assemble(Buffer<uint32_t> points) const;

  const Mesh& mesh_;
  std::function<void()> poll_;
  std::vector<uint32_t> vertex_of_point_;
  Corners fixed_;  ///< what was not chosen, and then what was set aside
  std::vector<Corners> parts_;
  std::vector<bool> is_locked_;  ///< [V] besides those that the caller locks
  Box box_;
  double scale_;  ///< a power of two that brings the box's longest side below 1
};

}  // namespace papilio
