#include "features.h"

#include "split_in_four.h"

namespace papilio {

void Features::fan(const Topology& mesh, size_t i, Fan& fan) const {
  fan.closed = is_closed[i] != 0;
  fan.spokes.assign(spokes.begin() + first_spoke[i], spokes.begin() + first_spoke[i + 1]);
  fan.centre = mesh.origin[fan.spokes[0]];
  fan.ring.clear();
  for (uint32_t s : fan.spokes) fan.ring.push_back(mesh.tip(s));
  if (!fan.closed) fan.ring.push_back(mesh.apex(fan.spokes.back()));
}

Features find_features(const Topology& mesh) {
  Features features;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.is_curve(h)) features.curve_half_edges.push_back(h);
  Fan fan;
  for_each_irregular_fan(mesh, fan, [&] {
    features.spokes.insert(features.spokes.end(), fan.spokes.begin(), fan.spokes.end());
    features.first_spoke.push_back(static_cast<uint32_t>(features.spokes.size()));
    features.is_closed.push_back(fan.closed ? 1 : 0);
  });
  return features;
}

void descend(Features& features) {
  ++features.level;
  for (uint32_t& spoke : features.spokes) spoke = first_half(spoke);
  std::vector<uint32_t> halves;
  halves.reserve(2 * features.curve_half_edges.size());
  for (uint32_t h : features.curve_half_edges)
    for (uint32_t half : {first_half(h), second_half(h)}) halves.push_back(half);
  features.curve_half_edges = std::move(halves);
}

}  // namespace papilio
