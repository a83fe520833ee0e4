#pragma once

#include <cstdint>

#include "detail/surface_place.h"
#include "detail/surface_tree.h"
#include "papilio/mesh.h"

namespace papilio {

/// The original with what its encoder looks up.
class OriginalSurface {
 public:
  /// The mesh must be closed and manifold, with its edges.
  explicit OriginalSurface(Mesh mesh);

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const SurfaceTree& tree() const { return tree_; }
  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] Vec3d point(const SurfacePlace& place) const;
  /// Unit normal, interpolated from those of the vertices; zero where they cancel out.
  [[nodiscard]] Vec3d normal(uint32_t face, Vec3d point) const;
  /// A face at each vertex.
  [[nodiscard]] uint32_t face_at(uint32_t vertex) const { return face_at_[vertex]; }

 private:
  Mesh mesh_;
  SurfaceTree tree_;
  Buffer<Vec3f> normals_;     // [V]
  Buffer<uint32_t> face_at_;  // [V]
  double diagonal_;
};

}  // namespace papilio
