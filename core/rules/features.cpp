#include "rules/features.h"

#include <algorithm>
#include <array>

#include "mesh/four_children.h"

namespace papilio {

bool is_regular(const Topology& mesh, const Fan& fan) {
  if (fan.closed) return fan.valence() == stencil::regular_valence && !is_dart(mesh, fan.centre);
  return fan.valence() == stencil::regular_curve_triangles && !is_corner(mesh, fan.centre);
}

void Features::fan(const Topology& mesh, size_t i, Fan& fan) const {
  fan.closed = is_closed[i] != 0;
  fan.centre = centre[i];
  fan.spokes.clear();
  fan.ring.clear();
  for (const Spoke& spoke : spokes_of(i)) {
    fan.spokes.push_back(spoke.half_edge);
    fan.ring.push_back(spoke.tip);
  }
  if (!fan.closed) fan.ring.push_back(mesh.apex(fan.spokes.back()));
}

bool Features::are_rings() const {
  if (!curve_half_edges.empty()) return false;
  for (size_t i = 0; i < fan_count(); ++i)
    if (!is_ring(i)) return false;
  return true;
}

namespace {

class FeatureFinder {
 public:
  explicit FeatureFinder(const Topology& mesh)
      : mesh_(mesh), corners_(mesh.vertex_count, 0), first_(Buffer<uint32_t>::for_overwrite(mesh.vertex_count)) {}

  Features run() {
    found_.has_darts = !mesh_.darts.empty();
    find_curves();
    count_corners();
    find_closed_fans();
    if (!found_.curve_half_edges.empty() || !mesh_.pinched.empty()) find_other_fans();
    return std::move(found_);
  }

 private:
  void find_curves() {
    const auto is_curve = [](EdgeKind kind) { return kind != EdgeKind::smooth; };
    if (std::none_of(mesh_.kind.begin(), mesh_.kind.end(), is_curve)) return;
    for (HalfEdgeId h = 0; h < mesh_.half_edge_count(); ++h)
      if (mesh_.kind[mesh_.edge[h]] == EdgeKind::cut)
        cut_half_edges_.push_back(h);
      else if (mesh_.is_curve(h))
        found_.curve_half_edges.push_back(h);
  }

  void count_corners() {
    for (uint32_t h = mesh_.half_edge_count(); h-- > 0;) {
      ++corners_[mesh_.origin[h]];
      first_[mesh_.origin[h]] = h;
    }
    for (HalfEdgeId h : found_.curve_half_edges) corners_[mesh_.origin[h]] = corners_[mesh_.tip(h)] = several;
    for (VertexId v : mesh_.pinched) corners_[v] = several;
    for (HalfEdgeId h : cut_half_edges_) corners_[mesh_.origin[h]] = corners_[mesh_.tip(h)] = unknown;
  }

  /// Adds the closed fans of irregular vertices without other fans: their number and sizes are known.
  void find_closed_fans() {
    std::array<uint32_t, classes + 1> start{};  // first fan of each class; at first, counts shifted by one class
    uint32_t spokes = 0;
    for (uint32_t corners : corners_)
      if (is_irregular(corners)) {
        ++start[class_of(corners) + 1];
        spokes += corners;
      }
    for (uint32_t c = 0; c < classes; ++c) start[c + 1] += start[c];
    const uint32_t fans = start[classes];
    found_.centre.resize_for_overwrite(fans);
    found_.is_closed.assign(fans, 1);
    found_.first_spoke.resize_for_overwrite(fans + 1);
    found_.spokes.resize_for_overwrite(spokes);
    for (VertexId v = 0; v < mesh_.vertex_count; ++v)
      if (is_irregular(corners_[v])) found_.centre[start[class_of(corners_[v])]++] = v;
    uint32_t known = 0;
    for (uint32_t i = 0; i < fans; ++i) {
      const VertexId v = found_.centre[i];
      found_.first_spoke[i] = known;
      uint32_t s = first_[v];
      for (const uint32_t end = known + corners_[v]; known < end; ++known) {
        found_.spokes[known] = {s, mesh_.edge[s], mesh_.tip(s)};
        s = mesh_.twin[Topology::previous(s)];
      }
    }
    found_.first_spoke[fans] = known;
  }

  void find_other_fans() {
    Buffer<uint8_t> visited(mesh_.half_edge_count(), 0);
    Fan fan;
    for (HalfEdgeId h = 0; h < mesh_.half_edge_count(); ++h) {
      if (corners_[mesh_.origin[h]] != several || visited[h] != 0) continue;
      collect_fan(mesh_, h, fan);
      for (uint32_t s : fan.spokes) visited[s] = 1;
      if (is_regular(mesh_, fan)) continue;
      for (uint32_t s : fan.spokes) found_.spokes.push_back({s, mesh_.edge[s], mesh_.tip(s)});
      found_.first_spoke.push_back(static_cast<uint32_t>(found_.spokes.size()));
      found_.centre.push_back(fan.centre);
      found_.is_closed.push_back(fan.closed ? 1 : 0);
    }
  }

  [[nodiscard]] static bool is_irregular(uint32_t corners) {
    return corners != stencil::regular_valence && corners != several && corners != unknown;
  }
  /// Returns the number of faces, or one class for all large numbers.
  [[nodiscard]] static uint32_t class_of(uint32_t corners) { return std::min(corners, classes - 1); }

  static constexpr uint32_t classes = stencil::harmonic_valence + 1;
  static constexpr uint32_t several = none;  ///< perhaps several fans: there is a curve, or the vertex is pinched
  static constexpr uint32_t unknown = 0;     ///< some faces are missing

  const Topology& mesh_;
  Buffer<uint32_t> corners_;  ///< [V] number of faces at the vertex, or `several`, or `unknown`
  Buffer<uint32_t> first_;    ///< [V] lowest half-edge that leaves the vertex
  Buffer<uint32_t> cut_half_edges_;
  Features found_;
};

}  // namespace

Features find_features(const Topology& mesh) { return FeatureFinder(mesh).run(); }

void descend(Features& features, uint32_t vertex_count) {
  ++features.level;
  for (size_t i = 0; i < features.fan_count(); ++i)
    for (uint32_t k = features.first_spoke[i]; k < features.first_spoke[i + 1]; ++k) {
      Features::Spoke& spoke = features.spokes[k];
      const uint32_t at_higher_end = features.centre[i] > spoke.tip ? 1 : 0;
      spoke = {first_half(spoke.half_edge), 2 * spoke.edge + at_higher_end, vertex_count + spoke.edge};
    }
  Buffer<uint32_t> halves;
  halves.reserve(2 * features.curve_half_edges.size());
  for (HalfEdgeId h : features.curve_half_edges)
    for (uint32_t half : {first_half(h), second_half(h)}) halves.push_back(half);
  features.curve_half_edges = std::move(halves);
}

}  // namespace papilio
