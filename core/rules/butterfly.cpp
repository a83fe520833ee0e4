#include "rules/butterfly.h"

#include <algorithm>
#include <optional>
#include <span>

#include "base/index_range.h"
#include "rules/butterfly_rules.h"

namespace papilio {
namespace {

bool has_all_twins(const Topology& mesh, FaceId f) {
  const uint32_t* twin = &mesh.twin[size_t{3} * f];
  return twin[0] != none && twin[1] != none && twin[2] != none;
}

/// Returns whether the edge's two faces, and the faces across their other sides, are held.
bool is_known(const Topology& mesh, HalfEdgeId h) {
  const HalfEdgeId t = mesh.twin[h];
  const auto is_cut = [&](uint32_t side) { return mesh.kind[mesh.edge[side]] == EdgeKind::cut; };
  return !is_cut(h.next()) && !is_cut(h.previous()) && !is_cut(t.next()) && !is_cut(t.previous());
}

template <class Real>
class Butterfly {
  using Point = Vec3T<Real>;

 public:
  Butterfly(const Topology& mesh, const Features& features, const Point* places, const Point* points,
            const ButterflyOptions<Real>& options)
      : mesh_(mesh),
        features_(features),
        points_(points),
        options_(options),
        rules_(mesh, places, points, options.w, options.tension) {
    if (options.tension != nullptr && options.tension->shape && !features.curve_half_edges.empty())
      curves_.emplace(mesh);
  }

  void run(Point* made) {
    split_by_rules(made);
    if (options_.tension != nullptr)
      for_each_edge([&](EdgeId e, HalfEdgeId h) { made[e] = rules_.finish(h, made[e], curves()); });
  }
  /// Computes the new vertices by the rules without their limits.
  void run_without_limits(Point* made) {
    split_by_rules(made);
    for_each_edge([&](EdgeId e, HalfEdgeId h) { made[e] = rules_.follow(h, made[e], curves()); });
  }
  /// Returns the share of its offset from the midpoint that the limits leave each vertex of `made`. [E]
  Buffer<Real> shares_within_limits(const Point* made) const {
    Buffer<Real> shares(mesh_.edge_count(), 1);
    for_each_edge([&](EdgeId e, HalfEdgeId h) {
      const Point q = rules_.limit(h, made[e]);
      if (q == made[e]) return;
      const Point middle = rules_.middle(h);
      shares[e] = std::min(Real(1), length(q - middle) / length(made[e] - middle));
    });
    return shares;
  }

 private:
  [[nodiscard]] const CurveNeighbours* curves() const { return curves_ ? &*curves_ : nullptr; }

  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    const uint32_t count = mesh_.edge_count();
    for_each_part(parts_of(count, options_.threads), count, [&](uint32_t, uint32_t first, uint32_t last) {
      for (EdgeId e = first; e < last; ++e) visit(e, mesh_.half_edge[e]);
    });
  }

  void split_by_rules(Point* made) {
    has_contribution_.assign(features_.level == 0 || options_.w != 0 ? mesh_.edge_count() : 0, 0);
    if (options_.w == 0)
      accumulate_by_faces(mesh_, IndexRange(mesh_.face_count()), made, options_.threads,
                          [rules = rules_, &mesh = mesh_](FaceId f, auto& shares) {
                            if (has_all_twins(mesh, f)) rules.add_face_shares(f, shares);
                          });
    split_near_curves(made);
    split_at_irregular_vertices(made);
    if (options_.w != 0)
      for_each_edge([&](EdgeId e, HalfEdgeId h) {
        const bool is_complete = options_.complete == nullptr || (*options_.complete)[e] != 0;
        if (is_complete && has_contribution_[e] == 0 && !mesh_.is_curve(h)) made[e] = rules_.regular(h);
      });
  }

  /// Computes the new vertices of edges on curves, and of the other edges of the faces there.
  void split_near_curves(Point* made) const {
    if (features_.curve_half_edges.empty()) return;
    const CurveNeighbours curves(mesh_);
    for (HalfEdgeId h : features_.curve_half_edges) {
      made[mesh_.edge[h]] = rules_.along_curve(curves, mesh_.edge[h]);
      for (uint32_t side : {h.next(), h.previous()})
        if (!mesh_.is_curve(side) && is_known(mesh_, side))
          made[mesh_.edge[side]] = rules_.regular(mesh_.half_edge[mesh_.edge[side]]);
    }
  }

  /// Adds contributions of the irregular fans to their spokes, in the order of the features: each ring is walked once,
  /// whatever its size. An edge with two irregular ends takes the mean of both.
  void split_at_irregular_vertices(Point* made) {
    Fan fan;
    for (size_t i = 0; i < features_.fan_count(); ++i) {
      const std::span<const Features::Spoke> spokes = features_.spokes_of(i);
      if (features_.is_ring(i) && rules_.are_whole(spokes, [](const auto& spoke) { return spoke.edge; })) {
        split_ring(
            points_, features_.centre[i], static_cast<uint32_t>(spokes.size()),
            [&](uint32_t j) { return spokes[j].tip; },
            [&](uint32_t j, Point q) { add_contribution(spokes[j].edge, q, made); });
        continue;
      }
      features_.fan(mesh_, i, fan);
      rules_.split_spokes(fan, [&](HalfEdgeId spoke, Point q) {
        if (!mesh_.is_curve(spoke)) add_contribution(mesh_.edge[spoke], q, made);  // not the crease that ends at a dart
      });
    }
  }
  void add_contribution(EdgeId e, Point q, Point* made) {
    // Below the coarse mesh one end of every edge is new, and regular.
    made[e] = features_.level == 0 && has_contribution_[e] != 0 ? Real(0.5) * (made[e] + q) : q;
    if (!has_contribution_.empty()) has_contribution_[e] = 1;
  }

  const Topology& mesh_;
  const Features& features_;
  const Point* points_;
  const ButterflyOptions<Real> options_;
  const ButterflyRules<Real> rules_;
  std::optional<CurveNeighbours> curves_;  ///< only if finish() needs them
  Marks has_contribution_;  ///< [E] whether an irregular end contributed; may be empty below the coarse mesh
};

}  // namespace

template <class Real>
void butterfly(const Topology& topology, const Features& features, const Vec3T<Real>* positions, Vec3T<Real>* made,
               const ButterflyOptions<Real>& options) {
  Butterfly<Real>(topology, features, positions, positions, options).run(made);
}

ButterflyOfVectors::ButterflyOfVectors(const Topology& topology, const Vec3f* positions,
                                       const ButterflyOptions<double>& options)
    : topology_(topology), features_(find_features(topology)), options_(options) {
  places_.reserve(topology.vertex_count);
  for (VertexId v = 0; v < topology.vertex_count; ++v) places_.push_back(to_double(positions[v]));
  if (options.tension == nullptr) return;
  Butterfly<double> rules(topology_, features_, places_.data(), places_.data(), options_);
  Buffer<Vec3d> made(topology.edge_count());
  rules.run_without_limits(made.data());
  shares_ = rules.shares_within_limits(made.data());
}

Buffer<Vec3d> ButterflyOfVectors::split(const Buffer<Vec3d>& vectors) const {
  Buffer<Vec3d> made(topology_.edge_count());
  Butterfly<double>(topology_, features_, places_.data(), vectors.data(), options_).run_without_limits(made.data());
  for (EdgeId e = 0; e < shares_.size(); ++e) {
    const HalfEdgeId h = topology_.half_edge[e];
    const Vec3d middle = 0.5 * (vectors[topology_.origin[h]] + vectors[topology_.tip(h)]);
    made[e] = middle + shares_[e] * (made[e] - middle);
  }
  return made;
}

template void butterfly(const Topology&, const Features&, const Vec3f*, Vec3f*, const ButterflyOptions<float>&);
template void butterfly(const Topology&, const Features&, const Vec3d*, Vec3d*, const ButterflyOptions<double>&);

}  // namespace papilio
