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
/// Squared error that a bit saves at a high rate, in squared steps. A step has the squared error step^2 / 12, and a bit
/// halves the step.
constexpr double error_of_bit = 0.1155;
/// Radius of the search for the original at an unknown distance, in steps.
constexpr float steps_to_look = 8;
/// Upper bound of the passes that restore residuals: restored residuals may turn over other faces. Few are left then.
constexpr int most_passes_back = 4;

/// Returns the other edges of an edge's faces; on a boundary, those of its one face twice.
std::array<uint32_t, 4> neighbours_of(const Topology& t, uint32_t e) {
  const uint32_t h = t.half_edge[e];
  const uint32_t twin = t.twin[h] != none ? t.twin[h] : h;
  return {t.edge[Topology::next(h)], t.edge[Topology::previous(h)], t.edge[Topology::next(twin)],
          t.edge[Topology::previous(twin)]};
}

/// Best change of a residual, and its gain.
struct Change {
  int32_t steps = 0;
  double gain = 0;
};

/// Finds the best change of a residual. `gradient`: decrease of half the squared error along the residual's direction.
/// `area`: area that the vertex moves. bits(residual) is the rate.
template <class Bits>
Change best_change(int32_t now, double gradient, double area, double step, double bit_cost, const Bits& bits) {
  const double curvature = squared_influence * area;
  const float bits_now = bits(now);
  Change best;
  const auto consider = [&](int32_t delta) {
    if (delta == 0 || std::abs(now + delta) > largest_residual) return;
    const double move = delta * step;
    const double gain = 2 * move * gradient - curvature * move * move - bit_cost * (bits(now + delta) - bits_now);
    if (gain > best.gain) best = {delta, gain};
  };
  const double wanted = curvature > 0 ? gradient / (curvature * step) : 0;
  const auto nearest = static_cast<int32_t>(std::lround(std::clamp(wanted, -1e6, 1e6)));
  for (const int32_t delta : {1, -1, -now, nearest, nearest > 0 ? nearest - 1 : nearest + 1}) consider(delta);
  return best;
}

}  // namespace

ResidualFit::ResidualFit(const OriginalSurface& original, Buffer<Vec3f> base, PlacedLevels placed, Poller poller)
    : original_(original),
      poller_(std::move(poller)),
      last_(std::move(placed.last)),
      positions_(std::move(base)),
      base_vertices_(static_cast<uint32_t>(positions_.size())) {
  for (size_t l = 0; l < placed.levels.size(); ++l)
    levels_.push_back({std::move(placed.levels[l]), std::move(placed.residuals[l])});
  on_.resize(last_.vertex_count, On::surface);
  for (const Level& level : levels_)
    for (const uint32_t e : level.level.curve_edges()) {
      const Topology& t = level.level.topology();
      const On on = t.kind[e] == EdgeKind::smooth ? On::seam : On::curve;
      for (const uint32_t v : {t.origin[t.half_edge[e]], t.tip(t.half_edge[e]), t.vertex_count + e})
        on_[v] = std::max(on_[v], on);
    }
  forward();
}

void ResidualFit::forward() {
  positions_.resize(base_vertices_);
  for (Level& level : levels_) place_new_vertices(level);
}

// Appends the new vertices of a level to the positions.
void ResidualFit::place_new_vertices(Level& level) {
  level.normals = residual_normals(level.level, positions_.data());
  level.level.predict(positions_);
  displace(level.level, level.normals, level.residuals, positions_);
}

void ResidualFit::improve(int turns, double rate_weight) {
  for (Level& level : levels_) {
    const uint32_t edges = level.level.topology().edge_count();
    if (level.stencils.first.empty()) level.stencils = linear_stencils(level.level.topology());
    level.gradient.resize(edges);
    level.area.resize(edges);
    level.gradient_across.resize(level.level.curve_edges().size());
  }
  std::vector<Residuals> before;
  for (const Level& level : levels_) before.push_back(level.residuals);
  const Buffer<Vec3f> normals = face_normals();
  distance_.assign(positions_.size(), -1);
  face_.assign(positions_.size(), none);
  for (int turn = 0; turn < turns; ++turn) {
    find_forces();
    double area = 0;
    for (const float a : area_) area += a;
    const double step = levels_.back().residuals.step;
    const double bit_cost = rate_weight * error_of_bit * step * step * area / static_cast<double>(area_.size());
    push_down();
    Level& level = levels_[static_cast<size_t>(turn) % levels_.size()];
    improve(level, bit_cost);
    improve_across(level, bit_cost);
    forward();
  }
  for (int pass = 0; pass < most_passes_back && turn_faces_back(before, normals);) ++pass;
}

// Returns the normals of the last level's faces, as long as twice their areas.
Buffer<Vec3f> ResidualFit::face_normals() const {
  Buffer<Vec3f> normals = Buffer<Vec3f>::for_overwrite(last_.face_count());
  for (uint32_t f = 0; f < last_.face_count(); ++f) {
    const uint32_t* v = &last_.origin[size_t{3} * f];
    normals[f] = cross(positions_[v[1]] - positions_[v[0]], positions_[v[2]] - positions_[v[0]]);
  }
  return normals;
}

// Restores the residuals of the vertices of faces that are turned from their `normals`, and of those vertices' parents.
// Returns whether there were such faces.
bool ResidualFit::turn_faces_back(const std::vector<Residuals>& before, const Buffer<Vec3f>& normals) {
  const Buffer<Vec3f> now = face_normals();
  std::vector<bool> is_back(positions_.size());
  for (uint32_t f = 0; f < now.size(); ++f)
    if (dot(now[f], normals[f]) < 0)
      for (uint32_t i = 0; i < 3; ++i) is_back[last_.origin[size_t{3} * f + i]] = true;
  if (std::ranges::find(is_back, true) == is_back.end()) return false;
  for (size_t l = levels_.size(); l-- > 0;) {
    Level& level = levels_[l];
    const Topology& t = level.level.topology();
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
      if (!is_back[t.vertex_count + e]) continue;
      level.residuals.along_normal[e] = before[l].along_normal[e];
      is_back[t.origin[t.half_edge[e]]] = is_back[t.tip(t.half_edge[e])] = true;
    }
    for (size_t c = 0; c < level.residuals.across.size(); ++c)
      if (is_back[t.vertex_count + level.level.curve_edges()[c]]) level.residuals.across[c] = before[l].across[c];
  }
  forward();
  return true;
}

void ResidualFit::find_forces() {
  const size_t count = positions_.size();
  area_.assign(count, 0);
  force_.assign(count, Vec3f{});  // area normals of the vertices at first
  for (uint32_t h = 0; h < last_.half_edge_count(); h += 3) {
    const uint32_t* v = &last_.origin[h];
    const Vec3f normal = cross(positions_[v[1]] - positions_[v[0]], positions_[v[2]] - positions_[v[0]]);
    const float third = length(normal) / 6;
    for (uint32_t i = 0; i < 3; ++i) {
      area_[v[i]] += third;
      force_[v[i]] += normal;
    }
  }
  for (uint32_t v = 0; v < count; ++v) {
    poller_.step();
    const Vec3d normal = to_double(force_[v]);
    const double size = length(normal);
    force_[v] = on_[v] != On::surface ? force_to_curve(v)
                : size > 0            ? force_to_surface(v, (1 / size) * normal)
                                      : Vec3f{};
  }
}

Vec3f ResidualFit::force_to_curve(uint32_t v) const {
  const Vec3d point = to_double(positions_[v]);
  const OriginalCurves& curves = on_[v] == On::seam ? original_.seams() : original_.curves();
  return to_float(area_[v] * (curves.nearest(point).point - point));
}

// Pulls a vertex to the nearest face of about its normal, or without such a face nearby, to the nearest point of all.
Vec3f ResidualFit::force_to_surface(uint32_t v, Vec3d normal) {
  const SurfaceTree& tree = original_.tree();
  const Vec3d point = to_double(positions_[v]);
  const Nearest near = nearest(v, normal);
  if (near.face == none) {
    distance_[v] = -1;
    return to_float(area_[v] * (tree.nearest(point).point - point));
  }
  const Vec3d across = tree.unit_normal(near.face);
  distance_[v] = static_cast<float>(std::sqrt(near.squared_distance));
  face_[v] = near.face;
  return to_float((area_[v] * dot(near.point - point, across)) * across);
}

// Returns the original's point nearest to the vertex, within the distance that it moves between turns. If the vertex
// lies straight above its last nearest face, no other face is searched.
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
    for (size_t c = 0; c < level.gradient_across.size(); ++c) {
      const uint32_t e = level.level.curve_edges()[c];
      const Vec3f across = residual_tangents(t, positions_.data(), e, level.normals[e]).across;
      level.gradient_across[c] = dot(force_[t.vertex_count + e], across);
    }
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
  Buffer<uint32_t> around(edges);  // [E] sum of the neighbours' magnitudes
  for (uint32_t e = 0; e < edges; ++e) {
    for (const uint32_t n : neighbours_of(t, e)) around[e] += static_cast<uint32_t>(std::abs(residual[n]));
    rates.count(around[e], residual[e]);
  }
  rates.finish();

  std::vector<Change> change(edges);
  for (uint32_t e = 0; e < edges; ++e)
    change[e] = best_change(residual[e], level.gradient[e], level.area[e], level.residuals.step, bit_cost,
                            [&](int32_t value) { return rates.bits(around[e], value); });
  // Applies only the best change of each neighbourhood: adjacent changes would overshoot.
  for (uint32_t e = 0; e < edges; ++e) {
    if (change[e].steps == 0) continue;
    if (std::ranges::all_of(neighbours_of(t, e), [&](uint32_t n) {
          return change[n].gain < change[e].gain || (change[n].gain == change[e].gain && n >= e);
        }))
      residual[e] += change[e].steps;
  }
}

// Changes the parts across curves, at most one of the two halves of an edge, as these are adjacent.
void ResidualFit::improve_across(Level& level, double bit_cost) {
  Buffer<int32_t>& across = level.residuals.across;
  RateTable rates;
  for (const int32_t part : across) rates.count(0, part);
  rates.finish();
  const auto change_of = [&](size_t c) {
    const uint32_t e = level.level.curve_edges()[c];
    if (level.residuals.tangential.contains(e)) return Change{};
    return best_change(across[c], level.gradient_across[c], level.area[e], level.residuals.step, bit_cost,
                       [&](int32_t value) { return rates.bits(0, value); });
  };
  for (size_t c = 0; c < across.size(); c += 2) {
    const Change one = change_of(c);
    const Change two = c + 1 < across.size() ? change_of(c + 1) : Change{};
    if (one.gain >= two.gain)
      across[c] += one.steps;
    else
      across[c + 1] += two.steps;
  }
}

void ResidualFit::set_last_residuals(Residuals residuals) {
  Level& last = levels_.back();
  last.residuals = std::move(residuals);
  positions_.resize(last.level.topology().vertex_count);
  place_new_vertices(last);
}

void ResidualFit::keep_levels(size_t count) {
  if (count >= levels_.size()) return;
  last_ = levels_[count].level.topology();
  positions_.resize(last_.vertex_count);
  while (levels_.size() > count) levels_.pop_back();
}

std::vector<std::vector<std::vector<uint8_t>>> ResidualFit::code(const PieceOrder& order,
                                                                 std::span<const uint32_t> piece_counts) const {
  std::vector<std::vector<std::vector<uint8_t>>> streams;
  const auto models = std::make_unique<ResidualModels>();
  Buffer<Vec3f> positions(positions_.begin(), positions_.begin() + base_vertices_);
  Buffer<int32_t> at_vertex(base_vertices_);
  for (const Level& level : levels_) {
    poller_.now();
    level.level.predict(positions);
    const EdgePieces pieces = order.edges(level.level.topology(), level.level.number(), piece_counts[streams.size()]);
    streams.push_back(
        encode_residuals({level.level, pieces, at_vertex, positions, level.normals}, level.residuals, *models));
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
