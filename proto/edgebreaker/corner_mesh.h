#pragma once

#include <array>
#include <cstdint>

#include "papilio/mesh.h"

namespace papilio::proto::edgebreaker {

/// A mesh as Draco's bitstream speaks of it. A face's three corners are where its half-edges leave; its edge that a
/// corner does not touch is the one opposite to it, and so is the corner of the other face at that edge. Faces lie
/// counter-clockwise; left and right are as seen from the corner, facing the opposite edge, from behind: right of a
/// corner is across the edge before it, left across its own.
///
/// Corner c is where half-edge c leaves. What a walk asks of a face lies together, and takes no more room than it
/// needs: a walk waits for memory most of the time.
class CornerMesh {
 public:
  explicit CornerMesh(const Topology& mesh)
      : vertex_count_(mesh.vertex_count), corners_(Buffer<Corner>::for_overwrite(size_t{3} * mesh.face_count())) {
    for (uint32_t f = 0; f < mesh.face_count(); ++f)
      add_face(f, &mesh.origin[size_t{3} * f], &mesh.twin[size_t{3} * f]);
  }

  /// The same faces, cut open along seams: `vertex` [corners] of the surface with this many vertices, `is_seam`
  /// [corners] where the edge opposite to the corner is one.
  CornerMesh(const CornerMesh& whole, const Buffer<uint8_t>& is_seam, const Buffer<uint32_t>& vertex,
             uint32_t vertex_count)
      : vertex_count_(vertex_count), corners_(Buffer<Corner>::for_overwrite(whole.corner_count())) {
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
  /// `none` at a boundary.
  [[nodiscard]] uint32_t opposite(uint32_t corner) const { return corners_[corner].opposite; }
  [[nodiscard]] uint32_t right(uint32_t corner) const { return opposite(next(corner)); }
  [[nodiscard]] uint32_t left(uint32_t corner) const { return opposite(previous(corner)); }
  /// The corner at the same vertex in the next face, counter-clockwise, or clockwise; `none` beyond a boundary.
  [[nodiscard]] uint32_t swing_left(uint32_t corner) const {
    const uint32_t across = opposite(next(corner));
    return across == none ? none : next(across);
  }
  [[nodiscard]] uint32_t swing_right(uint32_t corner) const {
    const uint32_t across = opposite(previous(corner));
    return across == none ? none : previous(across);
  }

  /// Gives the corner a vertex of another number.
  void set_vertex(uint32_t corner, uint32_t vertex) { corners_[corner].vertex = vertex; }

  /// Has what belongs to a corner's face fetched, for a walk that may soon come there; `none` may be given.
  void prefetch(uint32_t corner) const { __builtin_prefetch(&corners_[corner == none ? 0 : corner]); }

  /// The corners opposite to boundary edges, in ascending order.
  [[nodiscard]] const Buffer<uint32_t>& at_boundary() const { return at_boundary_; }
  /// Whether there are two faces that share more than one edge.
  [[nodiscard]] bool has_faces_folded_together() const { return has_faces_folded_together_; }

 private:
  struct Corner {
    uint32_t vertex, opposite;
  };

  void add_face(uint32_t f, const uint32_t* origin, const uint32_t* twin) {
    const uint32_t a = twin[1];  // what runs against the edge opposite to each corner
    const uint32_t b = twin[2];
    const uint32_t c = twin[0];
    Corner* corner = &corners_[size_t{3} * f];
    if ((a | b | c) == none && (a == none || b == none || c == none)) {
      add_face_at_boundary(f, origin, {a, b, c});
      return;
    }
    corner[0] = {origin[0], previous_of(a)};
    corner[1] = {origin[1], previous_of(b)};
    corner[2] = {origin[2], previous_of(c)};
    note_if_folded(corner[0].opposite, b);
    note_if_folded(corner[1].opposite, c);
    note_if_folded(corner[2].opposite, a);
  }
  /// Where a face runs against two edges of another, it comes to the later one first.
  void note_if_folded(uint32_t before_first, uint32_t second) {
    has_faces_folded_together_ = has_faces_folded_together_ || before_first == second;
  }

  void add_face_at_boundary(uint32_t f, const uint32_t* origin, const std::array<uint32_t, 3>& across) {
    for (uint32_t i = 0; i < 3; ++i) {
      corners_[size_t{3} * f + i] = {origin[i], across[i] == none ? none : previous_of(across[i])};
      if (across[i] == none) at_boundary_.push_back(3 * f + i);
      if (across[i] != none) note_if_folded(previous_of(across[i]), across[(i + 1) % 3]);
    }
  }

  /// In fewer steps than `previous`.
  static uint32_t previous_of(uint32_t half_edge) { return half_edge - 1 + (half_edge % 3 == 0 ? 3 : 0); }

  uint32_t vertex_count_;
  Buffer<Corner> corners_;
  Buffer<uint32_t> at_boundary_;
  bool has_faces_folded_together_ = false;
};

}  // namespace papilio::proto::edgebreaker
