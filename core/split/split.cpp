#include "split/split.h"

#include "mesh/attributes.h"
#include "split/split_pattern.h"

namespace papilio {
namespace {

class Splitter {
 public:
  Splitter(const Topology& mesh, const Marks& targets, const Buffer<Vec3f>& positions)
      : mesh_(mesh), targets_(targets), positions_(positions), before_(targets.size() + 1) {
    for (size_t e = 0; e < targets.size(); ++e) before_[e + 1] = before_[e] + targets[e];
  }

  Topology run(PointAttributes& attributes, const Displacements& displaced) {
    choose_patterns();
    const uint32_t faces = first_child_.back();
    child_.vertex_count = mesh_.vertex_count + before_.back();
    child_.pinched = mesh_.pinched;
    child_.darts = mesh_.darts;
    child_.shape = mesh_.shape;
    child_.origin.resize_for_overwrite(size_t{3} * faces);
    child_.twin.resize_for_overwrite(size_t{3} * faces);
    child_.edge.resize_for_overwrite(size_t{3} * faces);
    const uint32_t edges = inner_edge_base() + (faces - mesh_.face_count());
    child_.half_edge.resize_for_overwrite(edges);
    child_.kind.assign(edges, EdgeKind::smooth);
    for (EdgeId e = 0; e < mesh_.edge_count(); ++e) {
      const uint32_t base = e + before_[e];
      child_.kind[base] = mesh_.kind[e];
      if (targets_[e] != 0) child_.kind[base + 1] = mesh_.kind[e];
    }
    for (FaceId f = 0; f < mesh_.face_count(); ++f) split_face(f);
    if (!attributes.empty()) split_corners(attributes, displaced);
    return std::move(child_);
  }

 private:
  void choose_patterns() {
    const uint32_t faces = mesh_.face_count();
    pattern_.resize(faces);
    first_child_.resize(faces + 1);
    uint32_t child = 0;
    for (FaceId f = 0; f < faces; ++f) {
      const uint32_t* edge = &mesh_.edge[size_t{3} * f];
      const unsigned mask = targets_[edge[0]] | targets_[edge[1]] << 1U | targets_[edge[2]] << 2U;
      pattern_[f] = &split_pattern(mask, prefers_second_diagonal(f, mask));
      first_child_[f] = child;
      child += pattern_[f]->children;
    }
    first_child_[faces] = child;
  }

  /// Returns whether the second diagonal cuts the quadrangle that two targets leave: the shorter one; if equal, the
  /// one from the lower corner. False for other masks.
  [[nodiscard]] bool prefers_second_diagonal(FaceId f, unsigned mask) const {
    if (!has_two_targets(mask)) return false;
    const uint32_t i = first_target[mask];
    const uint32_t j = (i + 1) % 3;
    const VertexId first_end = mesh_.origin[3 * f + i];
    const VertexId second_end = mesh_.origin[3 * f + (j + 1) % 3];
    const auto at = [&](VertexId v) { return to_double(positions_[v]); };
    const Vec3d first = at(first_end) - at(new_vertex(3 * f + j));
    const Vec3d second = at(second_end) - at(new_vertex(3 * f + i));
    const double difference = dot(second, second) - dot(first, first);
    return difference < 0 || (difference == 0 && second_end < first_end);
  }

  [[nodiscard]] uint32_t new_vertex(HalfEdgeId h) const { return mesh_.vertex_count + before_[mesh_.edge[h]]; }

  [[nodiscard]] uint32_t inner_edge_base() const { return mesh_.edge_count() + before_.back(); }

  /// Returns the edge of the next level that is the first (0) or second (1) half of parent half-edge h, or all of it.
  /// The half at the lower vertex comes first, in either direction of h.
  [[nodiscard]] uint32_t outer_edge(HalfEdgeId h, uint32_t half) const {
    const EdgeId e = mesh_.edge[h];
    const uint32_t base = e + before_[e];
    if (targets_[e] == 0) return base;
    return base + (mesh_.origin[h] < mesh_.tip(h) ? half : 1 - half);
  }

  /// Returns the half-edge of the next level opposite to the first or second half of parent half-edge
  /// h, or to all of it.
  [[nodiscard]] uint32_t outer_twin(HalfEdgeId h, uint32_t half) const {
    const HalfEdgeId t = mesh_.twin[h];
    if (t == none) return none;
    const uint32_t half_of_twin = targets_[mesh_.edge[h]] != 0 ? 1 - half : 0;
    return 3 * first_child_[t.face()] + pattern_[t.face()]->outer[2 * (t % 3) + half_of_twin];
  }

  void split_face(FaceId f) {
    const SplitPattern& pattern = *pattern_[f];
    const uint32_t base = 3 * first_child_[f];
    const uint32_t inner_edges = inner_edge_base() + (first_child_[f] - f);
    for (uint32_t c = 0; c < 3U * pattern.children; ++c) {
      const HalfEdgeId h = base + c;
      const uint8_t corner = pattern.corner[c / 3][c % 3];
      child_.origin[h] = corner < 3 ? mesh_.origin[3 * f + corner] : new_vertex(3 * f + corner - 3);
      if (pattern.inner_twin[c] != SplitPattern::outside) {
        child_.twin[h] = base + pattern.inner_twin[c];
        child_.edge[h] = inner_edges + pattern.edge[c];
      } else {
        const uint32_t parent = 3 * f + pattern.edge[c] / 2;
        child_.twin[h] = outer_twin(parent, pattern.edge[c] % 2);
        child_.edge[h] = outer_edge(parent, pattern.edge[c] % 2);
      }
      child_.half_edge[child_.edge[h]] = h;
    }
  }

  void split_corners(PointAttributes& attributes, const Displacements& displaced) const {
    const Buffer<uint32_t> made = split_points(mesh_, targets_, IndexRange(mesh_.face_count()), attributes, displaced);
    auto point = Buffer<uint32_t>::for_overwrite(child_.half_edge_count());
    for (FaceId f = 0; f < mesh_.face_count(); ++f)
      for (uint32_t c = 0; c < 3U * pattern_[f]->children; ++c) {
        const uint8_t corner = pattern_[f]->corner[c / 3][c % 3];
        point[3 * first_child_[f] + c] = corner < 3 ? attributes.point[3 * f + corner] : made[3 * f + corner - 3];
      }
    attributes.point = std::move(point);
  }

  const Topology& mesh_;
  const Marks& targets_;
  const Buffer<Vec3f>& positions_;
  std::vector<const SplitPattern*> pattern_;  ///< [F]
  Buffer<uint32_t> before_;                   ///< [E + 1] number of targets before each edge
  Buffer<uint32_t> first_child_;              ///< [F + 1]
  Topology child_;
};

}  // namespace

uint64_t count_children(const Topology& mesh, const Marks& targets) {
  uint64_t children = mesh.face_count();
  for (EdgeId e : mesh.edge) children += targets[e];
  return children;
}

Topology split(const Topology& mesh, const Marks& targets, const Buffer<Vec3f>& positions, PointAttributes& attributes,
               const Displacements& displaced) {
  return Splitter(mesh, targets, positions).run(attributes, displaced);
}

}  // namespace papilio
