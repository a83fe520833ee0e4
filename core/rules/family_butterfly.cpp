#include "rules/family_butterfly.h"

#include <algorithm>
#include <array>
#include <span>

#include "base/index_range.h"
#include "rules/butterfly_rules.h"
#include "rules/child_stencil.h"

namespace papilio {
namespace {

/// Eight-point rule where every edge is split, for four faces at once (child_stencil.h). Each position is loaded once,
/// and the edges between the four are complete. `positions` are those of the faces' level.
class FamilyRule {
 public:
  explicit FamilyRule(const Vec3f* positions) : p_(positions) {}

  /// Adds the contributions of the family of face `parent` to its edges: bit-identical to
  /// `ButterflyRules::add_face_shares` for each of its four faces.
  template <class Shares>
  void add_shares(uint32_t parent, const ChildStencil& family, Shares& shares) const {
    std::array<Vec3fa, 3> corner, middle, across_first, across_second;
    for (uint32_t i = 0; i < 3; ++i) {
      corner[i] = widen(p_[family.corner[i]]);
      middle[i] = widen(p_[family.middle[i]]);
      across_first[i] = widen(p_[family.across_first[i]]);
      across_second[i] = widen(p_[family.across_second[i]]);
    }
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t next = (i + 1) % 3;
      const uint32_t before = (i + 2) % 3;
      // Child i has the corners corner[i], middle[i] and middle[before].
      const Vec3fa& wing = middle[next];  // across its inner side
      shares.add(parent, family.twin[i], family.first_half(i),
                 share_(corner[i], middle[i], middle[before], wing, across_second[before]));
      shares.add(parent, family.twin[before], family.second_half(before),
                 share_(middle[before], corner[i], middle[i], across_first[i], wing));
      shares.set(family.inner_edge(i),
                 share_(middle[i], middle[before], corner[i], across_second[before], across_first[i]) +
                     share_(middle[before], middle[i], wing, corner[next], corner[before]));
    }
  }

 private:
  const Vec3f* p_;
  stencil::FaceShare<float> share_{};
};

/// Computes new vertices for the children of some of the parents.
template <class Numbers>
void split_families(const Topology& parents, const IndexRange& faces, const Numbers& numbers, const Features& features,
                    const Vec3f* positions, Vec3f* made, int threads) {
  const FamilyRule rule(positions);
  accumulate_by_faces(parents, faces, made, threads, [&parents, rule, numbers](FaceId f, auto& shares) {
    rule.add_shares(f, ChildStencil(parents, f, numbers), shares);
  });
  const auto is_held = [&](const Features::Spoke& spoke) { return numbers.has_edge(spoke.edge); };
  for (size_t i = 0; i < features.fan_count(); ++i) {
    const std::span<const Features::Spoke> spokes = features.spokes_of(i);
    if (std::ranges::none_of(spokes, is_held)) continue;
    const VertexId centre = features.centre[i];
    split_ring(
        positions, centre, static_cast<uint32_t>(spokes.size()),
        [&](uint32_t j) { return parents.vertex_count + spokes[j].edge; },
        [&](uint32_t j, Vec3f q) { made[2 * numbers.edge(spokes[j].edge) + (centre > spokes[j].tip ? 1 : 0)] = q; });
  }
}

}  // namespace

void butterfly_below(const Topology& parents, const Part* part, const Features& features, const Vec3f* positions,
                     Vec3f* made, int threads) {
  if (part == nullptr)
    split_families(parents, IndexRange(parents.face_count()), OwnNumbers(parents.edge_count()), features, positions,
                   made, threads);
  else
    split_families(parents, IndexRange(part->faces.numbers()), PartNumbers(*part), features, positions, made, threads);
}

}  // namespace papilio
