#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio::proto::edgebreaker {

/// Mesh in the terms of Draco's bitstream. Corner c of a face is at the origin of half-edge c. The edge opposite to a
/// corner is the edge of its face that it does not touch. Its opposite corner is the corner of the other face at that
/// edge. Faces are counter-clockwise: right of a corner is across the edge before it, left across its own edge.
///
/// The vertex and the opposite of a corner share a cache line, as walks are bound by memory latency.
class CornerMesh {
 public:
  explicit CornerMesh(const Topology& mesh)
      : vertex_count_(mesh.vertex_count), corners_(size_t{3} * mesh.face_count()) {
    for (uint32_t c = 0; c < corner_count(); ++c) {
      const uint32_t twin = mesh.twin[next(c)];
      corners_[c] = {mesh.origin[c], twin == none ? none : previous(twin)};
      if (twin == none)
        at_boundary_.push_back(c);
      else if (corners_[c].opposite == mesh.twin[previous(c)])  // two consecutive edges face the same other face
        has_faces_folded_together_ = true;
    }
  }

  /// Cuts `whole` open along seams. `is_seam` [corners]: whether the edge opposite to the corner is a seam. `vertex`
  /// [corners]: the vertex of the corner after the cut.
  CornerMesh(const CornerMesh& whole, const Buffer<uint8_t>& is_seam, const Buffer<uint32_t>& vertex,
             uint32_t vertex_count)
      : vertex_count_(vertex_count), corners_(whole.corner_count()) {
    for (uint32_t c = 0; c < corner_count(); ++c) {
      corners_[c] = {vertex[c], is_seam[c] != 0 ? none : whole.opposite(c)};
      if (corners_[c].opposite == none) at_boundary_.push_back(c);
    }
  }

  [[nodiscard]] uint32_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] uint32_t face_count() const { return static_cast<uint32_t>(corners_.size() / 3); }
  [[nodiscard]] uint32_t corner_count() const { return static_cast<uint32_t>(corners_.size()); }
  static uint32_t face(uint32_t corner) { return corner / 3; }
  static uint32_t first_corner(uint32_t face) { return 3 * face; }
  static uint32_t next(uint32_t corner) { return Topology::next(corner); }
  static uint32_t previous(uint32_t corner) { return Topology::previous(corner); }
  [[nodiscard]] uint32_t vertex(uint32_t corner) const { return corners_[corner].vertex; }
  /// Returns the opposite corner; `none` at a boundary.
  [[nodiscard]] uint32_t opposite(uint32_t corner) const { return corners_[corner].opposite; }
  [[nodiscard]] uint32_t right(uint32_t corner) const { return opposite(next(corner)); }
  [[nodiscard]] uint32_t left(uint32_t corner) const { return opposite(previous(corner)); }
  /// Returns the corner at the same vertex of the next face counter-clockwise; `none` beyond a boundary.
  [[nodiscard]] uint32_t swing_left(uint32_t corner) const {
    const uint32_t across = opposite(next(corner));
    return across == none ? none : next(across);
  }
  /// Returns the corner at the same vertex of the next face clockwise; `none` beyond a boundary.
  [[nodiscard]] uint32_t swing_right(uint32_t corner) const {
    const uint32_t across = opposite(previous(corner));
    return across == none ? none : previous(across);
  }

  /// Moves the corner to another vertex.
  void set_vertex(uint32_t corner, uint32_t vertex) { corners_[corner].vertex = vertex; }

  /// Prefetches the cache line of a corner that a walk may visit next. `corner` may be `none`.
  void prefetch(uint32_t corner) const { __builtin_prefetch(&corners_[corner == none ? 0 : corner]); }

  /// Returns the corners opposite to boundary edges, in ascending order.
  [[nodiscard]] const Buffer<uint32_t>& at_boundary() const { return at_boundary_; }
  /// Returns whether two faces share more than one edge.
  [[nodiscard]] bool has_faces_folded_together() const { return has_faces_folded_together_; }

 private:
  struct Corner {
    uint32_t vertex, opposite;
  };

  uint32_t vertex_count_;
  Buffer<Corner> corners_;
  Buffer<uint32_t> at_boundary_;
  bool has_faces_folded_together_ = false;
};

}  // namespace papilio::proto::edgebreaker
