#pragma once

#include <memory>
#include <vector>

#include "base/ids.h"
#include "criteria/camera.h"
#include "papilio/buffer.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns the faces [F] that the view does not show, the paper's section 3.2. Either all three vertices are outside (a
/// vertex has its longest edge as radius), or the face is turned away (never without a normal). Shape: normals [F].
[[nodiscard]] std::vector<bool> hidden_faces(const Mesh& mesh, const Buffer<Vec3f>& normals, const Camera& camera);

/// Returns the length of each vertex's longest edge. [V]
[[nodiscard]] Buffer<double> longest_edges(const Mesh& mesh);
/// Returns the length of each vertex's longest edge on the level below `parents` (split_in_four.h), from
/// its positions. [V]
[[nodiscard]] Buffer<double> longest_edges_below(const Topology& parents, const Buffer<Vec3f>& positions);

class FaceVisibility;

/// Edges that a view shows, the paper's section 3.2. An edge is hidden if all its faces have all three vertices outside
/// (a vertex has its longest edge as radius). It is also hidden if all its faces are turned away: edges on the
/// silhouette are shown, and a face without normal is never away. A face is tested when one of its edges is first
/// tested. The mesh and its arrays must outlive this object.
class EdgesShown {
 public:
  /// All edges are shown.
  EdgesShown() = default;
  /// Shapes: normals [F], longest [V]; `shared`: half-edges at shared edges.
  EdgesShown(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Camera& camera,
             const Buffer<uint32_t>& shared);

  [[nodiscard]] bool operator[](EdgeId edge) const {
    if (faces_ == nullptr) return true;
    return (of_edge_[edge] >= is_known ? of_edge_[edge] : find(edge)) == shown;
  }

 private:
  friend class FaceVisibility;
  static constexpr uint8_t is_known = 4, shown = is_known | 3;  ///< besides the bits found for faces
  /// Computes the bits of an edge from its faces.
  [[nodiscard]] uint8_t find(EdgeId edge) const;

  std::shared_ptr<FaceVisibility> faces_;  ///< null: all edges are shown
  mutable Buffer<uint8_t> of_edge_;        ///< [E] bits of the edge's faces; below `is_known` unless all were tested
};

/// Returns whether the length of an edge is at least `edge_pixels` in pixels.
[[nodiscard]] bool is_long(const Mesh& mesh, const Camera& camera, double edge_pixels, EdgeId edge);

}  // namespace papilio
