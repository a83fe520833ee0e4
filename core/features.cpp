#include "features.h"

#include <algorithm>

#include "split_in_four.h"
#include "stencil.h"

namespace papilio {

void Features::fan(const Topology& mesh, size_t i, Fan& fan) const {
  const auto of_fan = [&](const std::vector<uint32_t>& all, std::vector<uint32_t>& its) {
    its.assign(all.begin() + first_spoke[i], all.begin() + first_spoke[i + 1]);
  };
  fan.closed = is_closed[i] != 0;
  fan.centre = centre[i];
  of_fan(spokes, fan.spokes);
  of_fan(tips, fan.ring);
  if (!fan.closed) fan.ring.push_back(mesh.apex(fan.spokes.back()));
}

namespace {

class FeatureFinder {
 public:
  explicit FeatureFinder(const Topology& mesh) : mesh_(mesh), corners_(mesh.vertex_count, 0) {}

  Features run() {
    find_curves();
    find_fans();
    for (const uint32_t s : found_.spokes) {
      found_.edges.push_back(mesh_.edge[s]);
      found_.tips.push_back(mesh_.tip(s));
    }
    return std::move(found_);
  }

 private:
  void find_curves() {
    const auto is_curve = [](EdgeKind kind) { return kind != EdgeKind::smooth; };
    if (std::none_of(mesh_.kind.begin(), mesh_.kind.end(), is_curve)) return;
    for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h)
      if (mesh_.is_curve(h)) found_.curve_half_edges.push_back(h);
  }

  void find_fans() {
    for (uint32_t v : mesh_.origin)
      if (corners_[v] < many) ++corners_[v];
    for (uint32_t h : found_.curve_half_edges) corners_[mesh_.origin[h]] = corners_[mesh_.tip(h)] = at_curve;
    for (uint32_t v : mesh_.pinched) corners_[v] = at_curve;
    std::vector<uint8_t> visited;  // [H], of fans at curves
    for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h) {
      uint8_t& corners = corners_[mesh_.origin[h]];
      if (corners == stencil::regular_valence) continue;
      if (corners != at_curve) {
        add_closed_fan(h);
        corners = stencil::regular_valence;  // done
        continue;
      }
      if (visited.empty()) visited.assign(mesh_.half_edge_count(), 0);
      if (visited[h] != 0) continue;
      collect_fan(mesh_, h, fan_);
      for (uint32_t s : fan_.spokes) visited[s] = 1;
      if (!is_regular(mesh_, fan_)) add(fan_.spokes, fan_.closed);
    }
  }

  /// Of a vertex all of whose faces go round it.
  void add_closed_fan(uint32_t h) {
    fan_.spokes.clear();
    uint32_t s = h;
    do {
      fan_.spokes.push_back(s);
      s = mesh_.twin[Topology::previous(s)];
    } while (s != h);
    add(fan_.spokes, true);
  }

  void add(const std::vector<uint32_t>& spokes, bool is_closed) {
    found_.spokes.insert(found_.spokes.end(), spokes.begin(), spokes.end());
    found_.first_spoke.push_back(static_cast<uint32_t>(found_.spokes.size()));
    found_.centre.push_back(mesh_.origin[spokes[0]]);
    found_.is_closed.push_back(is_closed ? 1 : 0);
  }

  static constexpr uint8_t many = 254, at_curve = 255;

  const Topology& mesh_;
  std::vector<uint8_t> corners_;  ///< [V] of faces at the vertex, `many` standing for more; or `at_curve`
  Fan fan_;
  Features found_;
};

}  // namespace

Features find_features(const Topology& mesh) { return FeatureFinder(mesh).run(); }

void descend(Features& features, const Topology& mesh) {
  ++features.level;
  for (uint32_t& spoke : features.spokes) spoke = first_half(spoke);
  for (size_t i = 0; i < features.fan_count(); ++i)
    for (uint32_t k = features.first_spoke[i]; k < features.first_spoke[i + 1]; ++k) {
      uint32_t& edge = features.edges[k];
      const uint32_t middle = mesh.vertex_count + edge;
      edge = 2 * edge + (features.centre[i] > features.tips[k] ? 1 : 0);
      features.tips[k] = middle;
    }
  std::vector<uint32_t> halves;
  halves.reserve(2 * features.curve_half_edges.size());
  for (uint32_t h : features.curve_half_edges)
    for (uint32_t half : {first_half(h), second_half(h)}) halves.push_back(half);
  features.curve_half_edges = std::move(halves);
}

}  // namespace papilio
