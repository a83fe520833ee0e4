#pragma once

#include <cstdint>
#include <vector>

#include "base/poller.h"
#include "detail/surface_tree.h"
#include "papilio/detail.h"

namespace papilio {

/// Simplified mesh whose vertices are moved nearer to the original. The squared distances of samples, from the original
/// to the mesh and back, are modelled as a quadratic function of small moves: a sample's distance changes by the part
/// of its triangle's move along the line to the nearest point.
class VertexFit {
 public:
  /// `original` must outlive this. About `samples` are taken of each surface.
  VertexFit(const SurfaceTree& original, const TriangleMesh& mesh, uint32_t samples, Poller poller = {});

  /// Moves the vertices `passes` times to the minimum of the squared distances, by a bounded length. Moves that would
  /// turn a face are left out.
  void improve(int passes);

  /// Moves vertices back to their first places, halfway at a time, where samples or vertices of either surface are
  /// farther than `most` from the other. Moves that would turn a face are left out.
  void retreat(double most);

  /// Returns the mesh with each vertex on a grid point near it. Of the grid points around, those are taken that leave
  /// the least squared distances, which are the nearest ones only across the surface. So a coarser grid serves.
  [[nodiscard]] TriangleMesh on_grid(const PositionGrid& grid);

  [[nodiscard]] TriangleMesh mesh() const;

 private:
  /// Symmetric 3 x 3 matrix.
  struct Block {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    void add(Vec3d u, double weight);
    [[nodiscard]] Vec3d operator*(Vec3d v) const;
    [[nodiscard]] Vec3d solve(Vec3d right, double damping) const;
    [[nodiscard]] double trace() const { return xx + yy + zz; }
  };

  void improve_once();
  void connect();
  /// Returns for each vertex whether a face of it is farther than `most` from the original, or the original from it.
  [[nodiscard]] std::vector<bool> far_vertices(double most) const;
  /// Samples both surfaces for the quadratic function, unless that is done.
  void measure();
  void add_sample(uint32_t face, Vec3d at, Vec3d to, Vec3d normal, double weight);
  /// Returns the gradient at a vertex without its own block, with the moves of its neighbours.
  [[nodiscard]] Vec3d pull_on(uint32_t v, const std::vector<Vec3d>& moves) const;
  [[nodiscard]] bool turns_face(uint32_t v, Vec3d place, const std::vector<Vec3d>& places) const;

  const SurfaceTree& original_;
  double diagonal_;
  std::vector<Triangle> faces_;
  std::vector<Vec3d> places_, first_places_;
  uint32_t samples_;
  double rms_ = 0;  ///< distance from the original's samples
  Poller poller_;
  std::vector<uint32_t> first_;       ///< [V + 1] first of a vertex's neighbours
  std::vector<uint32_t> neighbours_;  ///< in ascending order for each vertex
  std::vector<uint32_t> first_face_;  ///< [V + 1]
  std::vector<uint32_t> faces_of_;    ///< faces of each vertex
  bool is_measured_ = false;
  std::vector<Block> own_;     ///< [V]
  std::vector<Block> shared_;  ///< [neighbours_]
  std::vector<Vec3d> pulls_;   ///< [V]
};

}  // namespace papilio
