#include "detail/residual_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "detail/rate_table.h"
#include "detail/residual_frames.h"

namespace papilio {
namespace {

/// Sum of the squared influence of a vertex on the surface, as a share of its area.
constexpr double squared_influence = 0.55;
/// Error that a bit saves at a high rate, of a step's square: a bit halves the step, whose error is its square over 12.
constexpr double error_of_bit = 0.1155;
/// How far the original is looked for, in steps, where its distance is not known.
constexpr float steps_to_look = 8;

std::array<uint32_t, 4> neighbours_of(const Topology& t, uint32_t e) {
  const uint32_t h = t.half_edge[e];
  const uint32_t twin = t.twin[h];
  return {t.edge[Topology::next(h)], t.edge[Topology::previous(h)], t.edge[Topology::next(twin)],
          t.edge[Topology::previous(twin)]};
}

}  // namespace

ResidualFit::ResidualFit(const OriginalSurface& original, Buffer<Vec3f> base, PlacedLevels placed,
                         std::function<void()> poll)
    : original_(original),
      poll_(std::move(poll)),
      last_(std::move(placed.last)),
      positions_(std::move(base)),
      base_vertices_(static_cast<uint32_t>(positions_.size())) {
  for (size_t l = 0; l < placed.levels.size(); ++l)
    levels_.push_back({std::move(placed.levels[l]), std::move(placed.residuals[l])});
  forward();
}

void ResidualFit::forward() {
  positions_.resize(base_vertices_);
  for (Level& level : levels_) {
    level.normals = residual_normals(level.level.topology(), positions_.data());
    level.level.predict(positions_);
    displace(level.level, level.normals, level.residuals, positions_);
  }
}

void ResidualFit::improve(int turns, double rate_weight) {
  for (Level& level : levels_) {
    const uint32_t edges = level.level.topology().edge_count();
    if (level.stencils.first.empty()) level.stencils = linear_stencils(level.level.topology());
    level.gradient.resize(edges);
    level.area.resize(edges);
  }
  distance_.assign(positions_.size(), -1);
  face_.assign(positions_.size(), none);
  for (int turn = 0; turn < turns; ++turn) {
    if (poll_) poll_();
    find_forces();
    double area = 0;
    for (const float a : area_) area += a;
    const double step = levels_.back().residuals.step;
    const double bit_cost = rate_weight * error_of_bit * step * step * area / static_cast<double>(area_.size());
    push_down();
    improve(levels_[static_cast<size_t>(turn) % levels_.size()], bit_cost);
    forward();
  }
}

void ResidualFit::find_forces() {
  const size_t count = positions_.size();
  area_.assign(count, 0);
  force_.assign(count, Vec3f{});  // the vertices' area normals at first
  for (uint32_t h = 0; h < last_.half_edge_count(); h += 3) {
    const uint32_t* v = &last_.origin[h];
    const Vec3f normal = cross(positions_[v[1]] - positions_[v[0]], positions_[v[2]] - positions_[v[0]]);
    const float third = length(normal) / 6;
    for (uint32_t i = 0; i < 3; ++i) {
      area_[v[i]] += third;
      force_[v[i]] += normal;
    }
  }
  const SurfaceTree& tree = original_.tree();
  for (uint32_t v = 0; v < count; ++v) {
    const Vec3d normal = to_double(std::exchange(force_[v], Vec3f{}));
    const double size = length(normal);
    if (!(size > 0)) continue;
    const Nearest near = nearest(v, (1 / size) * normal);
    if (near.face == none) continue;
    const Vec3d point = to_double(positions_[v]);
    const Vec3d across = tree.unit_normal(near.face);
    force_[v] = to_float((area_[v] * dot(near.point - point, across)) * across);
    distance_[v] = static_cast<float>(std::sqrt(near.squared_distance));
    face_[v] = near.face;
  }
}

/// The original's point nearest to the vertex, as far as it moves from turn to turn. Where the vertex lies straight
/// above the face that was nearest, no other is looked for.
Nearest ResidualFit::nearest(uint32_t v, Vec3d normal) const {
  const SurfaceTree& tree = original_.tree();
  const Vec3d point = to_double(positions_[v]);
  const float step = levels_.back().residuals.step;
  if (distance_[v] < 0) return tree.nearest(point, steps_to_look * step, normal);
  const Vec3d across = tree.unit_normal(face_[v]);
  const auto [a, b, c] = tree.corners(face_[v]);
  const double offset = dot(a - point, across);
  const Vec3d foot = point + offset * across;
  const auto is_left = [&](Vec3d p, Vec3d q) { return dot(across, cross(q - p, foot - p)) >= 0; };
  if (dot(across, normal) > 0.5 && is_left(a, b) && is_left(b, c) && is_left(c, a))
    return {offset * offset, face_[v], foot};
  return tree.nearest(point, 1.2 * distance_[v] + 2 * step, normal);
}

void ResidualFit::push_down() {
  for (size_t l = levels_.size(); l-- > 0;) {
    Level& level = levels_[l];
    const Topology& t = level.level.topology();
    const LinearStencils& stencils = level.stencils;
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
      const uint32_t v = t.vertex_count + e;
      const Vec3f force = force_[v];
      level.gradient[e] = dot(force, level.normals[e]);
      level.area[e] = area_[v];
      for (uint32_t i = stencils.first[e]; i < stencils.first[e + 1]; ++i)
        force_[stencils.vertex[i]] += stencils.weight[i] * force;
      const uint32_t h = t.half_edge[e];
      area_[t.origin[h]] += area_[v] / 2;
      area_[t.tip(h)] += area_[v] / 2;
    }
  }
}

void ResidualFit::improve(Level& level, double bit_cost) {
  const Topology& t = level.level.topology();
  const uint32_t edges = t.edge_count();
  Buffer<int32_t>& residual = level.residuals.along_normal;
  RateTable rates;
  Buffer<uint32_t> around(edges);  // magnitudes of the neighbours
  for (uint32_t e = 0; e < edges; ++e) {
    for (const uint32_t n : neighbours_of(t, e)) around[e] += static_cast<uint32_t>(std::abs(residual[n]));
    rates.count(around[e], residual[e]);
  }
  rates.finish();

  Buffer<float> gain(edges);
  Buffer<int32_t> change(edges);
  const double step = level.residuals.step;
  for (uint32_t e = 0; e < edges; ++e) {
    const double gradient = level.gradient[e];
    const double curvature = squared_influence * level.area[e];
    const int32_t now = residual[e];
    const float bits = rates.bits(around[e], now);
    const auto consider = [&](int32_t delta) {
      if (delta == 0 || std::abs(now + delta) > largest_residual) return;
      const double move = delta * step;
      const double value =
          2 * move * gradient - curvature * move * move - bit_cost * (rates.bits(around[e], now + delta) - bits);
      if (value > gain[e]) gain[e] = static_cast<float>(value), change[e] = delta;
    };
    const double wanted = curvature > 0 ? gradient / (curvature * step) : 0;
    const auto best = static_cast<int32_t>(std::lround(std::clamp(wanted, -1e6, 1e6)));
    for (const int32_t delta : {1, -1, -now, best, best > 0 ? best - 1 : best + 1}) consider(delta);
  }
  // The best of each neighbourhood alone: changes beside each other would overshoot.
  for (uint32_t e = 0; e < edges; ++e) {
    if (change[e] == 0) continue;
    if (std::ranges::all_of(neighbours_of(t, e),
                            [&](uint32_t n) { return gain[n] < gain[e] || (gain[n] == gain[e] && n >= e); }))
      residual[e] += change[e];
  }
}

std::vector<std::vector<uint8_t>> ResidualFit::code() const {
  std::vector<std::vector<uint8_t>> streams;
  const auto models = std::make_unique<ResidualModels>();
  Buffer<Vec3f> positions(positions_.begin(), positions_.begin() + base_vertices_);
  Buffer<int32_t> at_vertex(base_vertices_);
  for (const Level& level : levels_) {
    level.level.predict(positions);
    streams.push_back(encode_residuals(level.level, level.residuals, at_vertex, positions, *models));
    displace(level.level, level.normals, level.residuals, positions);
    const Buffer<int32_t>& made = level.residuals.along_normal;
    at_vertex.insert(at_vertex.end(), made.begin(), made.end());
  }
  return streams;
}

TriangleMesh ResidualFit::surface(size_t levels) const {
  const Topology& t = levels == levels_.size() ? last_ : levels_[levels].level.topology();
  TriangleMesh made;
  made.positions.assign(positions_.begin(), positions_.begin() + t.vertex_count);
  for (uint32_t h = 0; h < t.half_edge_count(); h += 3)
    made.triangles.push_back({t.origin[h], t.origin[h + 1], t.origin[h + 2]});
  return made;
}

}  // namespace papilio
