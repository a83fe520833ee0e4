#pragma once

#include "mesh/ranks.h"
#include "mesh/region.h"
#include "papilio/mesh.h"

namespace papilio {

/// Subset of a mesh's faces and their edges, with compact indices. All other faces share one more index, the last: a
/// sentinel face, which a twin out of the part leads to. All other edges share a sentinel edge.
struct Part {
  /// Makes the part of the marked faces. `marks` [F]
  Part(const Topology& mesh, const Buffer<uint8_t>& marks)
      : faces(marks, Ranks::Others::alike),
        edges(used_by_faces(faces.numbers(), mesh.edge, mesh.edge_count()), Ranks::Others::alike) {}

  Ranks faces, edges;

  [[nodiscard]] uint32_t other_face() const { return faces.count(); }
  [[nodiscard]] uint32_t other_edge() const { return edges.count(); }
};

/// Indices of faces and edges of a whole mesh: their numbers.
class OwnNumbers {
 public:
  explicit OwnNumbers(uint32_t edge_count) : edge_count_(edge_count) {}
  [[nodiscard]] uint32_t face(uint32_t f) const { return f; }
  [[nodiscard]] uint32_t half_edge(uint32_t h) const { return h; }
  [[nodiscard]] uint32_t edge(uint32_t e) const { return e; }
  [[nodiscard]] bool has_edge(uint32_t /*e*/) const { return true; }
  [[nodiscard]] uint32_t edge_count() const { return edge_count_; }

 private:
  uint32_t edge_count_;
};

/// Compact indices of faces and edges of a part, which must outlive this.
class PartNumbers {
 public:
  explicit PartNumbers(const Part& part) : part_(&part) {}
  [[nodiscard]] uint32_t face(uint32_t f) const { return part_->faces[f]; }
  [[nodiscard]] uint32_t half_edge(uint32_t h) const { return 3 * face(Topology::face(h)) + h % 3; }
  [[nodiscard]] uint32_t edge(uint32_t e) const { return part_->edges[e]; }
  [[nodiscard]] bool has_edge(uint32_t e) const { return part_->edges.has(e); }
  [[nodiscard]] uint32_t edge_count() const { return part_->other_edge() + 1; }

 private:
  const Part* part_;
};

}  // namespace papilio
