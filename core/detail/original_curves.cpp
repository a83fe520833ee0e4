#include "detail/original_curves.h"

namespace papilio {
namespace {

std::vector<uint32_t> curve_edges(const Topology& t) {
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < t.edge_count(); ++e)
    if (t.kind[e] != EdgeKind::smooth) edges.push_back(e);
  return edges;
}

}  // namespace

OriginalCurves::OriginalCurves(const Mesh& mesh)
    : OriginalCurves(mesh, curve_edges(mesh.topology), curve_roles(mesh.topology)) {}

OriginalCurves::OriginalCurves(const Mesh& mesh, std::span<const uint32_t> edges, const std::vector<CurveRole>& roles)
    : positions_(mesh.positions) {
  const Topology& t = mesh.topology;
  TriangleMesh faces;
  std::vector<uint32_t> first(t.vertex_count, none);  // [V] first segment at a vertex inside a curve
  for (const uint32_t e : edges) {
    const uint32_t h = t.half_edge[e];
    const auto number = static_cast<uint32_t>(segments_.size());
    segments_.push_back({.vertex = {t.origin[h], t.tip(h)}});
    faces.triangles.push_back({t.origin[h], t.tip(h), t.tip(h)});
    for (uint32_t i = 0; i < 2; ++i) {
      const uint32_t v = segments_[number].vertex[i];
      if (roles[v] != CurveRole::inner) continue;
      const uint32_t other = std::exchange(first[v], number);
      if (other == none) continue;
      segments_[number].beyond[i] = other;
      segments_[other].beyond[segments_[other].vertex[0] == v ? 0 : 1] = number;
    }
  }
  if (empty()) return;
  faces.positions = mesh.positions;
  tree_.emplace(std::move(faces));
}

Nearest OriginalCurves::nearest(Vec3d point, double reach) const {
  return tree_ ? tree_->nearest(point, reach) : Nearest{};
}

std::optional<Vec3d> OriginalCurves::meet(uint32_t segment, Vec3d start, Vec3d point, Vec3d direction,
                                          double reach) const {
  const auto height = [&](Vec3d p) { return dot(p - point, direction); };
  const double first_height = height(start);
  if (first_height == 0) return start;
  const auto [a, b] = segments_[segment].vertex;
  // Starts towards the plane.
  uint32_t end = (height(place(b)) > height(place(a))) == (first_height < 0) ? 1 : 0;
  Vec3d from = start;
  for (size_t step = 0; step <= segments_.size(); ++step) {
    const Vec3d to = place(segments_[segment].vertex[end]);
    const double h0 = height(from);
    const double h1 = height(to);
    if ((h0 < 0) != (h1 < 0) || h1 == 0) {
      const Vec3d met = from + (h0 / (h0 - h1)) * (to - from);
      return length(met - start) <= reach ? std::optional(met) : std::nullopt;
    }
    if (length(to - start) > reach) return std::nullopt;
    const uint32_t next = segments_[segment].beyond[end];
    if (next == none) return std::nullopt;
    end = segments_[next].vertex[0] == segments_[segment].vertex[end] ? 1 : 0;
    segment = next;
    from = to;
  }
  return std::nullopt;
}

}  // namespace papilio
