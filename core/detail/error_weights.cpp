#include "detail/error_weights.h"

#include <algorithm>
#include <cmath>

namespace papilio {
namespace {

constexpr double largest_weight = 100;
/// Radius of the weights, in edges, and the decay over each edge.
constexpr int rings = 8;
constexpr float share_of_ring = 0.9F;

}  // namespace

void weigh_errors(const OriginalSurface& original, TriangleMesh surface, std::vector<float>& weights,
                  const Poller& poller) {
  const SurfaceTree tree(std::move(surface));
  const Buffer<Vec3f>& positions = original.mesh().positions;
  std::vector<double> squared;
  double mean = 0;
  for (const Vec3f p : positions) {
    poller.step();
    squared.push_back(tree.nearest(to_double(p)).squared_distance);
    mean += squared.back() / static_cast<double>(positions.size());
  }
  std::vector<float> factor;
  factor.reserve(squared.size());
  for (const double d : squared)
    factor.push_back(static_cast<float>(std::clamp(mean > 0 ? std::sqrt(d / mean) : 1, 1.0, largest_weight)));
  const Topology& t = original.mesh().topology;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<float> spread = factor;
    for (uint32_t h = 0; h < t.half_edge_count(); ++h)
      spread[t.origin[h]] = std::max(spread[t.origin[h]], share_of_ring * factor[t.tip(h)]);
    factor = std::move(spread);
  }
  weights.resize(positions.size(), 1);
  for (size_t v = 0; v < weights.size(); ++v) weights[v] *= factor[v];
}

}  // namespace papilio
