#pragma once

#include <memory>
#include <vector>

#include "criteria/camera.h"
#include "mesh/region.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"

namespace papilio {

/// The faces [F] that the view does not show, the paper's section 3.2: all three vertices are outside (a vertex counts
/// with its longest edge as radius), or the face is turned away (one without normal never is). Shape: normals [F].
[[nodiscard]] std::vector<bool> hidden_faces(const Mesh& mesh, const Buffer<Vec3f>& normals, const Camera& camera);

/// The length of each vertex's longest edge. [V]
[[nodiscard]] Buffer<double> longest_edges(const Mesh& mesh);
/// The same of the level below `parents` (split_in_four.h), from its positions; of the edges of some faces' children
/// alone, if `faces` is not null.
[[nodiscard]] Buffer<double> longest_edges_below(const Topology& parents, const Buffer<Vec3f>& positions,
                                                 const Buffer<uint32_t>* faces = nullptr);

/// The edges that a view shows, the paper's section 3.2: not those all of whose faces have all three vertices outside
/// (a vertex counts with its longest edge as radius), nor those all of whose faces are turned away (so edges on the
/// silhouette are shown; a face without normal is never away). A face is looked at when one of its edges is asked for.
/// The mesh and its arrays must outlive this.
class EdgesShown {
 public:
  /// All edges are.
  EdgesShown();
  /// Shapes: normals [F], longest [V]; `box` of the vertices; `shared`: the half-edges at shared edges.
  EdgesShown(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Box& box,
             const Camera& camera, const Buffer<uint32_t>& shared);
  EdgesShown(EdgesShown&& other) noexcept;
  EdgesShown& operator=(EdgesShown&& other) noexcept;
  EdgesShown(const EdgesShown&) = delete;
  EdgesShown& operator=(const EdgesShown&) = delete;
  ~EdgesShown();

  [[nodiscard]] bool operator[](uint32_t edge) const;
  /// Keeps those edges of the list that are; they are the region's.
  void keep_shown(const Region& region, Buffer<uint32_t>& edges) const;

 private:
  class Memory;
  std::unique_ptr<Memory> memory_;  ///< none: all are
};

/// Whether an edge looks at least so long, in pixels.
[[nodiscard]] bool is_long(const Mesh& mesh, const Camera& camera, double edge_pixels, uint32_t edge);
/// Keeps those edges of the list that do.
void keep_long(const Mesh& mesh, const Camera& camera, double edge_pixels, Buffer<uint32_t>& edges);

}  // namespace papilio
