#pragma once

#include <cstdint>
#include <vector>

#include "detail/original_curves.h"
#include "detail/surface_place.h"
#include "detail/surface_tree.h"
#include "papilio/mesh.h"

namespace papilio {

/// Original with the search structures of the encoder.
class OriginalSurface {
 public:
  /// Prepares the mesh, which must be manifold, with edges, creases and corners.
  explicit OriginalSurface(Mesh mesh);
  OriginalSurface(const OriginalSurface&) = delete;
  OriginalSurface& operator=(const OriginalSurface&) = delete;
  ~OriginalSurface() = default;

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const SurfaceTree& tree() const { return tree_; }
  [[nodiscard]] const OriginalCurves& curves() const { return curves_; }
  /// Returns the edges at which charts of the mesh's attributes meet, in ascending order.
  [[nodiscard]] const std::vector<uint32_t>& seam_edges() const { return seam_edges_; }
  /// Returns the seams on smooth edges. Other seams are on curves.
  [[nodiscard]] const OriginalCurves& seams() const { return seams_; }
  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] Vec3d point(const SurfacePlace& place) const;
  /// Returns the unit normal, interpolated from normals of corners, which are smooth except across creases; zero where
  /// they cancel out.
  [[nodiscard]] Vec3d normal(uint32_t face, Vec3d point) const;
  /// Returns whether a boundary or crease passes through the vertex.
  [[nodiscard]] bool is_on_curve(uint32_t vertex) const { return is_on_curve_[vertex] != 0; }
  /// Returns a face at the vertex.
  [[nodiscard]] uint32_t face_at(uint32_t vertex) const { return face_at_[vertex]; }

 private:
  Mesh mesh_;
  SurfaceTree tree_;
  OriginalCurves curves_;
  std::vector<uint32_t> seam_edges_;
  OriginalCurves seams_;
  Buffer<Vec3f> normals_;        // [H] normals of the faces from curve to curve round each corner
  Buffer<uint32_t> face_at_;     // [V]
  Buffer<uint8_t> is_on_curve_;  // [V]
  double diagonal_;
};

}  // namespace papilio
