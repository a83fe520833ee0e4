#include "rules/butterfly.h"

#include "rules/butterfly_rules.h"
#include "rules/features.h"

namespace papilio {
namespace {

template <class Real>
class Butterfly {
  using Point = Vec3T<Real>;

 public:
  Butterfly(const Topology& topology, const Buffer<Point>& positions, const SplitPlan& plan, Real w,
            const TensionField* tension)
      : mesh_(topology),
        plan_(plan),
        rules_(topology, positions.data(), w, tension),
        out_(Buffer<Point>::for_overwrite(plan.count())),
        irregular_ends_(plan.count(), 0) {}

  Buffer<Point> run() {
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
      out_[rank] = rules_.finish(mesh_.half_edge[e], out_[rank], &curves);
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
  Buffer<Point> out_;
  Buffer<uint8_t> irregular_ends_;  ///< [plan.count()] opinions already in `out_`: 0, 1 or 2
};

}  // namespace

template <class Real>
Buffer<Vec3T<Real>> butterfly(const Topology& topology, const Buffer<Vec3T<Real>>& positions, const SplitPlan& plan,
                              Real w, const TensionField* tension) {
  return Butterfly<Real>(topology, positions, plan, w, tension).run();
}

template Buffer<Vec3f> butterfly(const Topology&, const Buffer<Vec3f>&, const SplitPlan&, float, const TensionField*);
template Buffer<Vec3d> butterfly(const Topology&, const Buffer<Vec3d>&, const SplitPlan&, double, const TensionField*);

}  // namespace papilio
