#include "detail/detail_level.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "rules/butterfly.h"
#include "split/split_in_four.h"

namespace papilio {

DetailLevel::DetailLevel(Topology base, const std::vector<uint32_t>& seams)
    : topology_(std::move(base)), features_(find_features(topology_)) {
  auto seam = seams.begin();
  for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
    const bool is_seam = seam != seams.end() && *seam == e;
    if (is_seam) ++seam;
    if (is_seam || topology_.kind[e] != EdgeKind::smooth) curve_edges_.push_back(e);
  }
}

DetailLevel DetailLevel::next() const {
  DetailLevel made;
  made.topology_ = split_in_four(topology_);
  made.features_ = features_;
  descend(made.features_, topology_.vertex_count);
  made.curve_edges_.reserve(2 * curve_edges_.size());
  for (const uint32_t e : curve_edges_) {
    made.curve_edges_.push_back(2 * e);
    made.curve_edges_.push_back(2 * e + 1);
  }
  made.number_ = number_ + 1;
  made.vertices_before_ = topology_.vertex_count;
  return made;
}

void DetailLevel::predict(Buffer<Vec3f>& positions) const {
  positions.resize_for_overwrite(size_t{topology_.vertex_count} + topology_.edge_count());
  butterfly<float>(topology_, features_, positions.data(), positions.data() + topology_.vertex_count);
}

ResidualContext DetailLevel::context(uint32_t e, uint32_t piece, std::span<const CodedResidual> coded,
                                     std::span<const int32_t> at_vertex, const Vec3f* positions, Vec3f normal,
                                     float step) const {
  const Topology& t = topology_;
  const uint32_t h = t.half_edge[e];
  const uint32_t from = t.origin[h];
  const uint32_t to = t.tip(h);
  const auto is_recent = [&](uint32_t v) { return number_ > 0 && v >= vertices_before_; };
  ResidualContext c;
  c.level = number_ + 1;
  uint32_t magnitudes = 0;
  uint32_t weights = 0;
  const auto add_parent = [&](uint32_t v, uint32_t weight) {
    if (!is_recent(v)) return;
    magnitudes += weight * static_cast<uint32_t>(std::abs(at_vertex[v]));
    weights += weight;
  };
  for (const uint32_t v : {from, to}) {
    add_parent(v, 2);
    if (is_recent(v)) c.ends += at_vertex[v];
  }
  const bool is_half = is_recent(from) != is_recent(to);  // of an edge of the level before
  if (is_half && e % 2 == 1 && coded[e - 1].piece == piece) {
    c.has_sibling = true;
    c.sibling = coded[e - 1].along_normal;
  }
  const auto add_beyond = [&](uint32_t edge) {
    const CodedResidual& other = coded[edge];
    if (other.piece != piece) return;
    c.has_beyond = true;
    c.beyond += other.along_normal;
  };
  size_t i = 0;
  for (const uint32_t side : {h, t.twin[h]}) {
    if (side == none) continue;
    for (const uint32_t near : {Topology::next(side), Topology::previous(side)}) {
      if (const CodedResidual& other = coded[t.edge[near]]; other.piece == piece) {
        ++c.known;
        c.neighbours[i] = other.along_normal;
        c.free_neighbours += other.is_free ? 1 : 0;
      }
      if (const uint32_t across = t.twin[near]; across != none) {
        add_beyond(t.edge[Topology::next(across)]);
        add_beyond(t.edge[Topology::previous(across)]);
      }
      ++i;
    }
    add_parent(t.apex(side), 1);
  }
  c.parents = weights == 0 ? 0 : 8 * magnitudes / weights;
  const Vec3f off = positions[t.vertex_count + e] - 0.5F * (positions[from] + positions[to]);
  const float turn = 8 * length(off) / step;
  c.turn = turn < 1e6F ? static_cast<uint32_t>(turn) : 1000000U;
  const float bow = dot(off, normal) / step;
  c.bow = std::abs(bow) < 1e6F ? static_cast<double>(bow) : 0;
  return c;
}

CurveContext DetailLevel::curve_context(uint32_t c, std::span<const int32_t> residual, std::span<const int32_t> across,
                                        std::span<const int32_t> at_vertex) const {
  const uint32_t h = topology_.half_edge[curve_edges_[c]];
  CurveContext context;
  context.level = number_ + 1;
  if (number_ == 0) return context;
  for (const uint32_t v : {topology_.origin[h], topology_.tip(h)})
    if (v >= vertices_before_) context.parent = static_cast<uint32_t>(std::abs(at_vertex[v]));
  if (c % 2 == 0) return context;
  context.has_sibling = true;
  context.sibling = residual[curve_edges_[c - 1]];
  context.sibling_across = across[c - 1];
  return context;
}

}  // namespace papilio
