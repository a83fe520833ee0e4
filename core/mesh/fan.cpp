#include "mesh/fan.h"

#include <algorithm>

namespace papilio {

bool is_dart(const Topology& mesh, VertexId vertex) { return std::ranges::binary_search(mesh.darts, uint32_t{vertex}); }

bool is_corner(const Topology& mesh, VertexId vertex) {
  return std::ranges::binary_search(mesh.shape.corners, uint32_t{vertex});
}

namespace {

/// Steps from spoke to spoke; `none` across a curve. A crease does not stop steps round a dart, but a cut does, as
/// faces beyond it are missing.
class Steps {
 public:
  Steps(const Topology& mesh, VertexId centre) : mesh_(mesh), is_dart_(is_dart(mesh, centre)) {}
  [[nodiscard]] uint32_t clockwise(HalfEdgeId h) const { return ends_at(h) ? none : Topology::next(mesh_.twin[h]); }
  [[nodiscard]] uint32_t counter_clockwise(HalfEdgeId h) const {
    const HalfEdgeId incoming = h.previous();
    return ends_at(incoming) ? none : mesh_.twin[incoming];
  }

 private:
  [[nodiscard]] bool ends_at(HalfEdgeId h) const {
    return mesh_.is_curve(h) && !(is_dart_ && mesh_.kind[mesh_.edge[h]] == EdgeKind::crease);
  }
  const Topology& mesh_;
  const bool is_dart_;
};

}  // namespace

void collect_fan(const Topology& mesh, HalfEdgeId h, Fan& fan) {
  const Steps steps(mesh, mesh.origin[h]);
  fan.centre = mesh.origin[h];
  const auto walk_from = [&](uint32_t first) {
    fan.spokes.clear();
    fan.ring.clear();
    uint32_t s = first;
    do {
      fan.spokes.push_back(s);
      fan.ring.push_back(mesh.tip(s));
      s = steps.counter_clockwise(s);
    } while (s != none && s != first);
    fan.closed = s == first;
  };
  walk_from(h);
  if (fan.closed) return;
  uint32_t first = h;
  for (uint32_t s = steps.clockwise(h); s != none; s = steps.clockwise(s)) first = s;
  if (first != h) walk_from(first);
  fan.ring.push_back(mesh.apex(fan.spokes.back()));
}

}  // namespace papilio
