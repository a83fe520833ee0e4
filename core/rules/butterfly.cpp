#include "rules/butterfly.h"

#include <algorithm>

#include "rules/butterfly_rules.h"
#include "rules/features.h"

namespace papilio {
namespace {

template <class Real>
class Butterfly {
  using Point = Vec3T<Real>;

 public:
  Butterfly(const Topology& topology, const Buffer<Point>& places, const Buffer<Point>& points, const SplitPlan& plan,
            Real w, const TensionField* tension)
      : mesh_(topology),
        plan_(plan),
        rules_(topology, places.data(), points.data(), w, tension),
        out_(Buffer<Point>::for_overwrite(plan.count())),
        irregular_ends_(plan.count(), 0) {}

  Buffer<Point> run() {
    split_linearly();
    for_each_target([&](uint32_t rank, uint32_t h) { out_[rank] = rules_.limit(h, out_[rank]); });
    return std::move(out_);
  }

  /// What the rules make without their limits, and which part of the way from the middle of its edge each vertex may
  /// go under them.
  Buffer<Point> run_without_limits() {
    split_linearly();
    return std::move(out_);
  }
  Buffer<Real> shares_within_limits() {
    split_linearly();
    Buffer<Real> shares(out_.size(), 1);
    for_each_target([&](uint32_t rank, uint32_t h) {
      const Point q = rules_.limit(h, out_[rank]);
      if (q == out_[rank]) return;
      const Point middle = rules_.middle(h);
      shares[rank] = std::min(Real(1), length(q - middle) / length(out_[rank] - middle));
    });
    return shares;
  }

 private:
  template <class Visit>
  void for_each_target(const Visit& visit) const {
    for (uint32_t e = 0; e < mesh_.edge_count(); ++e)
      if (plan_.is_split(e)) visit(plan_.before[e], mesh_.half_edge[e]);
  }

  void split_linearly() {
    split_at_irregular_vertices();
    const CurveNeighbours curves(mesh_);
    for_each_target([&](uint32_t rank, uint32_t h) {
      const uint32_t e = mesh_.edge[h];
      if (mesh_.kind[e] != EdgeKind::smooth)
        out_[rank] = rules_.along_curve(curves, e);
      else if (irregular_ends_[rank] == 2)
        out_[rank] = Real(0.5) * out_[rank];
      else if (irregular_ends_[rank] == 0)
        out_[rank] = rules_.regular(h);
      out_[rank] = rules_.follow(h, out_[rank], &curves);
    });
  }

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
  return Butterfly<Real>(topology, positions, positions, plan, w, tension).run();
}

ButterflyOfVectors::ButterflyOfVectors(const Topology& topology, const Vec3f* positions, const SplitPlan& plan,
                                       double w, const TensionField* tension)
    : topology_(topology), plan_(plan), w_(w), tension_(tension) {
  places_.reserve(topology.vertex_count);
  for (uint32_t v = 0; v < topology.vertex_count; ++v) places_.push_back(to_double(positions[v]));
  if (tension != nullptr)
    shares_ = Butterfly<double>(topology, places_, places_, plan, w, tension).shares_within_limits();
}

Buffer<Vec3d> ButterflyOfVectors::split(const Buffer<Vec3d>& vectors) const {
  Buffer<Vec3d> made = Butterfly<double>(topology_, places_, vectors, plan_, w_, tension_).run_without_limits();
  for (uint32_t e = 0; e < topology_.edge_count() && tension_ != nullptr; ++e) {
    if (!plan_.is_split(e)) continue;
    const uint32_t h = topology_.half_edge[e];
    const Vec3d middle = 0.5 * (vectors[topology_.origin[h]] + vectors[topology_.tip(h)]);
    Vec3d& vector = made[plan_.before[e]];
    vector = middle + shares_[plan_.before[e]] * (vector - middle);
  }
  return made;
}

template Buffer<Vec3f> butterfly(const Topology&, const Buffer<Vec3f>&, const SplitPlan&, float, const TensionField*);
template Buffer<Vec3d> butterfly(const Topology&, const Buffer<Vec3d>&, const SplitPlan&, double, const TensionField*);

}  // namespace papilio
