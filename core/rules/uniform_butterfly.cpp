#include "rules/uniform_butterfly.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/index_range.h"
#include "base/parallel.h"
#include "rules/butterfly_rules.h"
#include "rules/child_stencil.h"

namespace papilio {
namespace {

bool has_all_twins(const Topology& mesh, uint32_t f) {
  const uint32_t* twin = &mesh.twin[size_t{3} * f];
  return twin[0] != none && twin[1] != none && twin[2] != none;
}

/// Calls add_shares(face, shares) for these faces, of a level or of the level above.
template <class AddShares>
void add_all_shares(const Topology& mesh, const IndexRange& faces, Vec3f* made, int threads,
                    const AddShares& add_shares) {
  if (faces.size() == 0) return;
  const EdgeAccumulator<float> shares{made};
  const uint32_t parts = parts_of(faces.size(), threads);
  std::vector<DeferredEdgeAccumulator<float>> late_of(parts, {shares, 0});
  for_each_part(parts, faces.size(), [&](uint32_t part, uint32_t first, uint32_t last) {
    DeferredEdgeAccumulator<float> late(shares, faces[first]);
    const AddShares add = add_shares;  // this thread's own, and so in registers
    for (uint32_t i = first; i < last; ++i) {
      const uint32_t f = faces[i];
      const uint32_t* twin = &mesh.twin[size_t{3} * f];
      if (late.is_early(std::min({twin[0], twin[1], twin[2]}))) [[unlikely]]
        add(f, late);
      else
        add(f, shares);
    }
    late_of[part] = std::move(late);
  });
  for (const DeferredEdgeAccumulator<float>& late : late_of) late.end();
}

/// What the children of a face know, where `shares` are by the faces of the level above.
template <class Shares>
class ChildShares {
 public:
  ChildShares(uint32_t parent, Vec3f* made, Shares& shares) : parent_(parent), inside_{made}, shares_(shares) {}
  void add(uint32_t face, uint32_t twin, uint32_t edge, Vec3fa share) {
    const uint32_t neighbour = Topology::face(twin) / 4;
    if (neighbour == parent_)
      inside_.add(face, twin, edge, share);
    else
      shares_.add(parent_, 3 * neighbour, edge, share);
  }

 private:
  uint32_t parent_;
  EdgeAccumulator<float> inside_;
  Shares& shares_;
};

/// Whether the edge's two faces are held, and those across their other sides.
bool is_known(const Topology& mesh, uint32_t h) {
  const uint32_t t = mesh.twin[h];
  const auto is_cut = [&](uint32_t side) { return mesh.kind[mesh.edge[side]] == EdgeKind::cut; };
  return !is_cut(Topology::next(h)) && !is_cut(Topology::previous(h)) && !is_cut(Topology::next(t)) &&
         !is_cut(Topology::previous(t));
}

/// The edges on curves, and those of the faces there.
void split_near_curves(const Topology& mesh, const Features& features, const ButterflyRules<float>& rules,
                       Vec3f* made) {
  if (features.curve_half_edges.empty()) return;
  const CurveNeighbours curves(mesh);
  for (uint32_t h : features.curve_half_edges) {
    made[mesh.edge[h]] = rules.along_curve(curves, mesh.edge[h]);
    for (uint32_t side : {Topology::next(h), Topology::previous(h)})
      if (!mesh.is_curve(side) && is_known(mesh, side))
        made[mesh.edge[side]] = rules.regular(mesh.half_edge[mesh.edge[side]]);
  }
}

/// Fans that are not regular, in the order of the features: calls add(edge, position) for their spokes. `mesh` and
/// `rules` may be null where all are rings and there is no tension.
template <class Add>
void split_at_irregular_vertices(const Features& features, const Vec3f* positions, const Topology* mesh,
                                 const ButterflyRules<float>* rules, const Add& add) {
  Fan fan;
  for (size_t i = 0; i < features.fan_count(); ++i) {
    const std::span<const Features::Spoke> spokes = features.spokes_of(i);
    const auto are_whole = [&] { return rules->are_whole(spokes, [](const auto& spoke) { return spoke.edge; }); };
    if (mesh == nullptr || rules == nullptr || (features.is_ring(i) && are_whole())) {
      split_ring(
          positions, features.centre[i], static_cast<uint32_t>(spokes.size()),
          [&](uint32_t j) { return spokes[j].tip; }, [&](uint32_t j, Vec3f q) { add(spokes[j].edge, q); });
      continue;
    }
    features.fan(*mesh, i, fan);
    rules->split_spokes(
        fan, [](uint32_t) { return true; },
        [&](uint32_t spoke, Vec3f q) {
          const uint32_t e = mesh->edge[spoke];
          if (mesh->kind[e] == EdgeKind::smooth) add(e, q);  // not the crease that ends at a dart
        });
  }
}

}  // namespace

void uniform_butterfly(const Topology& topology, const Features& features, const Vec3f* positions, Vec3f* made,
                       const TensionField* tension, int threads) {
  const ButterflyRules<float> rules(topology, positions, 0, tension);
  add_all_shares(topology, IndexRange(topology.face_count()), made, threads,
                 [rules, &topology](uint32_t f, auto& shares) {
                   if (has_all_twins(topology, f)) rules.add_face_shares(f, shares);
                 });
  split_near_curves(topology, features, rules, made);

  Buffer<uint8_t> has_opinion;  // [E] of an irregular end
  if (features.level == 0) has_opinion.assign(topology.edge_count(), 0);
  const auto add_opinion = [&](uint32_t e, Vec3f q) {
    if (features.level > 0) {
      made[e] = q;  // below the coarse mesh one end of every edge is new, and regular
      return;
    }
    made[e] = has_opinion[e] != 0 ? 0.5F * (made[e] + q) : q;
    has_opinion[e] = 1;
  };
  split_at_irregular_vertices(features, positions, &topology, &rules, add_opinion);
  if (tension == nullptr) return;
  std::optional<CurveNeighbours> found;
  if (tension->shape && !features.curve_half_edges.empty()) found.emplace(topology);
  const CurveNeighbours* curves = found ? &*found : nullptr;
  for_each_part(parts_of(topology.edge_count(), threads), topology.edge_count(),
                [&](uint32_t, uint32_t first, uint32_t last) {
                  for (uint32_t e = first; e < last; ++e)
                    made[e] = rules.finish(topology.half_edge[e], made[e], curves);
                });
}

void uniform_butterfly_below(const Topology& parents, const Topology* topology, const Features& features,
                             const Vec3f* positions, Vec3f* made, int threads, const Buffer<uint32_t>* asked_of) {
  std::optional<ButterflyRules<float>> rules;
  if (topology != nullptr) rules.emplace(*topology, positions, 0, nullptr);
  const FamilyRule<float> family_rule(positions);
  const auto add_shares = [&parents, topology, &rules, family_rule, made](uint32_t f, auto& shares) {
    if (has_all_twins(parents, f)) {
      family_rule.add_shares(f, ChildStencil(parents, f), shares);
      return;
    }
    ChildShares of_children(f, made, shares);
    for (uint32_t child = 4 * f; child < 4 * f + 4; ++child)  // at a border, one by one
      if (has_all_twins(*topology, child)) rules->add_face_shares(child, of_children);
  };
  add_all_shares(parents, IndexRange(parents.face_count(), asked_of), made, threads, add_shares);
  if (topology != nullptr) split_near_curves(*topology, features, *rules, made);
  split_at_irregular_vertices(features, positions, topology, rules ? &*rules : nullptr,
                              [&](uint32_t e, Vec3f q) { made[e] = q; });
}

void uniform_butterfly_below(const Topology& parents, const Part& part, const Features& features_of_parents,
                             const Vec3f* positions, Vec3f* made, int threads) {
  const FamilyRule<float> family_rule(positions);
  const PartNumbers numbers(part);
  add_all_shares(parents, IndexRange(part.faces.numbers()), made, threads,
                 [&parents, family_rule, numbers](uint32_t f, auto& shares) {
                   family_rule.add_shares(f, ChildStencil(parents, f, numbers), shares);
                 });
  const auto is_in_part = [&](const Features::Spoke& spoke) { return part.edges.has(spoke.edge); };
  for (size_t i = 0; i < features_of_parents.fan_count(); ++i) {
    const std::span<const Features::Spoke> spokes = features_of_parents.spokes_of(i);
    if (std::ranges::none_of(spokes, is_in_part)) continue;
    const uint32_t centre = features_of_parents.centre[i];
    split_ring(
        positions, centre, static_cast<uint32_t>(spokes.size()),
        [&](uint32_t j) { return parents.vertex_count + spokes[j].edge; },
        [&](uint32_t j, Vec3f q) { made[2 * part.edges[spokes[j].edge] + (centre > spokes[j].tip ? 1 : 0)] = q; });
  }
}

}  // namespace papilio
