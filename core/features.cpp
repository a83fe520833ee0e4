#include "features.h"

#include <algorithm>

#include "split_in_four.h"
#include "stencil.h"

namespace papilio {

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

namespace {

class FeatureFinder {
 public:
  explicit FeatureFinder(const Topology& mesh) : mesh_(mesh), corners_(mesh.vertex_count, 0) {}

  Features run() {
    find_curves();
    find_fans();
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
    Array<uint8_t> visited;  // [H], of fans at curves
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
      if (!is_regular(mesh_, fan_)) add_collected_fan();
    }
  }

  /// Of a vertex all of whose faces go round it.
  void add_closed_fan(uint32_t h) {
    uint32_t s = h;
    do {
      const uint32_t incoming = Topology::previous(s);
      found_.spokes.push_back({s, mesh_.edge[s], mesh_.tip(s)});
      s = mesh_.twin[incoming];
    } while (s != h);
    end_fan(mesh_.origin[h], true);
  }

  void add_collected_fan() {
    for (uint32_t s : fan_.spokes) found_.spokes.push_back({s, mesh_.edge[s], mesh_.tip(s)});
    end_fan(fan_.centre, fan_.closed);
  }

  void end_fan(uint32_t centre, bool is_closed) {
    found_.first_spoke.push_back(static_cast<uint32_t>(found_.spokes.size()));
    found_.centre.push_back(centre);
    found_.is_closed.push_back(is_closed ? 1 : 0);
  }

  static constexpr uint8_t many = 254, at_curve = 255;

  const Topology& mesh_;
  Array<uint8_t> corners_;  ///< [V] of faces at the vertex, `many` standing for more; or `at_curve`
  Fan fan_;
  Features found_;
};

}  // namespace

Features find_features(const Topology& mesh) { return FeatureFinder(mesh).run(); }

void descend(Features& features, const Topology& mesh) {
  ++features.level;
  for (size_t i = 0; i < features.fan_count(); ++i)
    for (uint32_t k = features.first_spoke[i]; k < features.first_spoke[i + 1]; ++k) {
      Features::Spoke& spoke = features.spokes[k];
      const uint32_t at_higher_end = features.centre[i] > spoke.tip ? 1 : 0;
      spoke = {first_half(spoke.half_edge), 2 * spoke.edge + at_higher_end, mesh.vertex_count + spoke.edge};
    }
  Array<uint32_t> halves;
  halves.reserve(2 * features.curve_half_edges.size());
  for (uint32_t h : features.curve_half_edges)
    for (uint32_t half : {first_half(h), second_half(h)}) halves.push_back(half);
  features.curve_half_edges = std::move(halves);
}

}  // namespace papilio
