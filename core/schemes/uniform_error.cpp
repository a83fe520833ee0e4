#include "schemes/uniform_error.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "criteria/deviation.h"
#include "criteria/deviation_cutoff.h"
#include "rules/child_stencil.h"
#include "simd/vec3fa.h"

namespace papilio {
namespace {

/// Largest deviation so far. Computes a deviation only if the edge's vertex is far enough from the midpoint.
class Largest {
 public:
  explicit Largest(DeviationCutoff too_near) : too_near_(too_near) {}

  /// Adds the edge from a to b with the new vertex `made`.
  template <class Deviation>
  void add(const Vec3f& made, const Vec3f& a, const Vec3f& b, const Deviation& deviation) {
    if (squared_length(widen(made) - 0.5F * (widen(a) + widen(b))) <= too_near_.squared()) return;
    distance_ = std::max(distance_, deviation());
    too_near_.raise(distance_);
  }
  [[nodiscard]] double distance() const { return distance_; }

 private:
  DeviationCutoff too_near_;
  double distance_ = 0;
};

/// Returns the largest deviation that add(begin, end, largest) adds over ranges of [0, count).
template <class Add>
double find_largest(const Buffer<Vec3f>& positions, uint32_t count, int threads, const Add& add) {
  const Largest none_yet(DeviationCutoff(bounding_box({positions.data(), positions.size()}).largest_coordinate()));
  const uint32_t parts = parts_of(count, threads);
  std::vector<Largest> found(parts, none_yet);
  for_each_part(parts, count, [&](uint32_t part, uint32_t first, uint32_t last) {
    Largest own = none_yet;
    add(first, last, own);
    found[part] = own;
  });
  return std::ranges::max_element(found, {}, &Largest::distance)->distance();
}

/// Adds the inner edges of the children of face `parent`, and the halves of sides at which it is the lower of two
/// faces.
void add_family(const Topology& parents, uint32_t parent, const Vec3f* p, const Vec3f* made, Largest& largest) {
  const ChildStencil family(parents, parent);
  // Adds an edge from its lower vertex a to b, with the apexes of its left and right face.
  const auto add = [&](EdgeId edge, uint32_t a, uint32_t b, uint32_t apex, uint32_t other_apex) {
    largest.add(made[edge], p[a], p[b],
                [&] { return deviation_from_faces(made[edge], p[a], p[b], p[apex], p[other_apex]); });
  };
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t next = (i + 1) % 3;
    const uint32_t before = (i + 2) % 3;
    if (family.middle[i] < family.middle[before])
      add(family.inner_edge(i), family.middle[i], family.middle[before], family.corner[i], family.middle[next]);
    else
      add(family.inner_edge(i), family.middle[before], family.middle[i], family.middle[next], family.corner[i]);
    if (family.twin[i] < 3 * parent) continue;
    add(family.first_half(i), family.corner[i], family.middle[i], family.middle[before], family.across_first[i]);
    add(family.second_half(i), family.corner[next], family.middle[i], family.across_second[i], family.middle[next]);
  }
}

}  // namespace

double largest_deviation(const Mesh& mesh, const Vec3f* made, int threads) {
  const Topology& topology = mesh.topology;
  const auto add = [&](uint32_t first, uint32_t last, Largest& largest) {
    for (EdgeId e = first; e < last; ++e) {
      const HalfEdgeId h = topology.half_edge[e];
      largest.add(made[e], mesh.positions[topology.origin[h]], mesh.positions[topology.tip(h)],
                  [&] { return deviation(mesh, e, made[e]); });
    }
  };
  return find_largest(mesh.positions, topology.edge_count(), threads, add);
}

double largest_deviation_below(const Topology& parents, const Buffer<Vec3f>& positions, const Vec3f* made,
                               int threads) {
  const auto add = [&](uint32_t first, uint32_t last, Largest& largest) {
    for (FaceId f = first; f < last; ++f) add_family(parents, f, positions.data(), made, largest);
  };
  return find_largest(positions, parents.face_count(), threads, add);
}

}  // namespace papilio
