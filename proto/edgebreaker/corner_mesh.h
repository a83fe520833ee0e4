#pragma once

#include <cstdint>

#include "core/mesh.h"

namespace papilio::proto::edgebreaker {

/// A mesh as Draco's bitstream speaks of it. Corner c is where half-edge c leaves; its face's edge that it does not
/// touch is the one opposite to it, and so is the corner of the other face at that edge. Faces lie counter-clockwise;
/// left and right are as seen from the corner, facing the opposite edge, from behind: right of corner c is across the
/// edge before it, left across its own.
class CornerMesh {
 public:
  /// Each vertex must have one fan of faces. The topology must outlive this.
  explicit CornerMesh(const Topology& mesh) : mesh_(mesh), opposite_(mesh.half_edge_count()) {
    for (uint32_t c = 0; c < opposite_.size(); ++c) {
      const uint32_t t = mesh.twin[Topology::next(c)];
      opposite_[c] = t == none ? none : Topology::previous(t);
    }
  }

  [[nodiscard]] uint32_t vertex_count() const { return mesh_.vertex_count; }
  [[nodiscard]] uint32_t face_count() const { return mesh_.face_count(); }
  [[nodiscard]] uint32_t corner_count() const { return mesh_.half_edge_count(); }
  static uint32_t face(uint32_t corner) { return corner / 3; }
  static uint32_t next(uint32_t corner) { return Topology::next(corner); }
  static uint32_t previous(uint32_t corner) { return Topology::previous(corner); }
  [[nodiscard]] uint32_t vertex(uint32_t corner) const { return mesh_.origin[corner]; }
  /// `none` at a boundary.
  [[nodiscard]] uint32_t opposite(uint32_t corner) const { return opposite_[corner]; }
  [[nodiscard]] uint32_t right(uint32_t corner) const { return opposite_[next(corner)]; }
  [[nodiscard]] uint32_t left(uint32_t corner) const { return opposite_[previous(corner)]; }

 private:
  const Topology& mesh_;
  Array<uint32_t> opposite_;
};

}  // namespace papilio::proto::edgebreaker
