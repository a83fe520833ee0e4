#include "butterfly.h"

#include <algorithm>

#include "butterfly_rules.h"
#include "parallel.h"

namespace papilio {
namespace {

template <class Real>
class Butterfly {
  using Point = Vec3T<Real>;

 public:
  Butterfly(const Topology& topology, const Array<Point>& positions, const SplitPlan& plan, Real w,
            const TensionField* tension)
      : mesh_(topology),
        plan_(plan),
        rules_(topology, positions.data(), w, tension),
        out_(plan.count()),
        irregular_ends_(plan.count(), 0) {}

  Array<Point> run() {
    split_at_irregular_vertices();
    const CurveNeighbours curves(mesh_);
    for (uint32_t e = 0; e < mesh_.edge_count(); ++e) {
      if (!plan_.is_split(e)) continue;
      const uint32_t rank = plan_.before[e];
      if (mesh_.kind[e] != EdgeKind::smooth)
        out_[rank] = rules_.along_curve(curves, e);
      else if (irregular_ends_[rank] == 2)
        out_[rank] = Real(0.5) * out_[rank];
      else if (irregular_ends_[rank] == 0)
        out_[rank] = rules_.regular(mesh_.half_edge[e]);
      out_[rank] = rules_.finish(mesh_.half_edge[e], out_[rank]);
    }
    return std::move(out_);
  }

 private:
  // Irregular vertices go first, fan by fan: each adds its own opinion to its spokes, so that a ring is
  // walked once however large it is. An edge with two irregular ends takes the mean of the two.
  void split_at_irregular_vertices() {
    Fan fan;
    const auto wants = [&](uint32_t spoke) { return plan_.is_split(mesh_.edge[spoke]); };
    const auto add = [&](uint32_t spoke, Point q) {
      if (!wants(spoke)) return;
      const uint32_t rank = plan_.before[mesh_.edge[spoke]];
      out_[rank] = irregular_ends_[rank]++ == 0 ? q : out_[rank] + q;
    };
    const Features features = find_features(mesh_);
    for (size_t i = 0; i < features.fan_count(); ++i) {
      features.fan(mesh_, i, fan);
      rules_.split_spokes(fan, wants, add);
    }
  }

  const Topology& mesh_;
  const SplitPlan& plan_;
  ButterflyRules<Real> rules_;
  Array<Point> out_;
  Array<uint8_t> irregular_ends_;  ///< [plan.count()] opinions already in `out_`: 0, 1 or 2
};

/// Where every edge is split: regular ones first, face by face, then what is otherwise near curves and irregular
/// vertices.
class UniformButterfly {
 public:
  UniformButterfly(const Topology& topology, const Features& features, const Vec3f* positions, Vec3f* made,
                   const TensionField* tension)
      : mesh_(topology),
        features_(features),
        rules_(topology, positions, 0, tension),
        made_(made),
        is_tensed_(tension != nullptr) {}

  void run(int threads) {
    split_faces(parts_of(mesh_.face_count(), threads));
    if (!features_.curve_half_edges.empty()) split_near_curves();
    split_at_irregular_vertices();
    if (is_tensed_)
      for_each_part(parts_of(mesh_.edge_count(), threads), mesh_.edge_count(),
                    [this](uint32_t, uint32_t first, uint32_t last) {
                      for (uint32_t e = first; e < last; ++e) made_[e] = rules_.finish(mesh_.half_edge[e], made_[e]);
                    });
  }

 private:
  void split_faces(uint32_t parts) {
    const FaceShares<float> shares{made_};
    std::vector<LateFaceShares<float>> late_of(parts, {shares, 0});
    for_each_part(parts, mesh_.face_count(), [&](uint32_t part, uint32_t first, uint32_t last) {
      LateFaceShares<float> late(shares, first);
      const ButterflyRules<float> rules = rules_;
      for (uint32_t f = first; f < last; ++f) {
        const uint32_t* twin = &mesh_.twin[size_t{3} * f];
        if (twin[0] == none || twin[1] == none || twin[2] == none) continue;
        if (late.is_early(std::min({twin[0], twin[1], twin[2]}))) [[unlikely]]
          rules.add_face_shares(f, late);
        else
          rules.add_face_shares(f, shares);
      }
      late_of[part] = std::move(late);
    });
    for (const LateFaceShares<float>& late : late_of) late.end();
  }

  void split_near_curves() {
    const CurveNeighbours curves(mesh_);
    for (uint32_t h : features_.curve_half_edges) {
      made_[mesh_.edge[h]] = rules_.along_curve(curves, mesh_.edge[h]);
      for (uint32_t side : {Topology::next(h), Topology::previous(h)})
        if (!mesh_.is_curve(side)) made_[mesh_.edge[side]] = rules_.regular(mesh_.half_edge[mesh_.edge[side]]);
    }
  }

  void split_at_irregular_vertices() {
    if (features_.level == 0) has_opinion_.assign(mesh_.edge_count(), 0);
    Fan fan;
    for (size_t i = 0; i < features_.fan_count(); ++i) {
      const std::span<const Features::Spoke> spokes = features_.spokes_of(i);
      if (!is_tensed_ && features_.is_closed[i] != 0 && spokes.size() < stencil::harmonic_valence &&
          mesh_.darts.empty()) {
        rules_.split_ring(
            features_.centre[i], static_cast<uint32_t>(spokes.size()), [&](uint32_t j) { return spokes[j].tip; },
            [&](uint32_t j, Vec3f q) { add_opinion(spokes[j].edge, q); });
        continue;
      }
      features_.fan(mesh_, i, fan);
      rules_.split_spokes(
          fan, [](uint32_t) { return true; },
          [&](uint32_t spoke, Vec3f q) {
            const uint32_t e = mesh_.edge[spoke];
            if (mesh_.kind[e] == EdgeKind::smooth) add_opinion(e, q);  // not the crease that ends at a dart
          });
    }
  }

  void add_opinion(uint32_t e, Vec3f q) {
    if (features_.level > 0) {
      made_[e] = q;  // below the coarse mesh one end of every edge is new, and regular
      return;
    }
    made_[e] = has_opinion_[e] != 0 ? 0.5F * (made_[e] + q) : q;
    has_opinion_[e] = 1;
  }

  const Topology& mesh_;
  const Features& features_;
  ButterflyRules<float> rules_;
  Vec3f* made_;  ///< [E]
  bool is_tensed_;
  Array<uint8_t> has_opinion_;  ///< [E] of an irregular end; on the coarse mesh only
};

}  // namespace

template <class Real>
Array<Vec3T<Real>> butterfly(const Topology& topology, const Array<Vec3T<Real>>& positions, const SplitPlan& plan,
                             Real w, const TensionField* tension) {
  return Butterfly<Real>(topology, positions, plan, w, tension).run();
}

template Array<Vec3f> butterfly(const Topology&, const Array<Vec3f>&, const SplitPlan&, float, const TensionField*);
template Array<Vec3d> butterfly(const Topology&, const Array<Vec3d>&, const SplitPlan&, double, const TensionField*);

void uniform_butterfly(const Topology& topology, const Features& features, const Vec3f* positions, Vec3f* made,
                       const TensionField* tension, int threads) {
  UniformButterfly(topology, features, positions, made, tension).run(threads);
}

}  // namespace papilio
