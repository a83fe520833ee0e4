#pragma once

#include <numbers>

#include "tests/support/reference_surface.h"

namespace papilio::reference {

struct EdgeError {
  double value = 0, slope = 0;
  uint64_t faces = 0;  ///< that splitting the edge adds
  int edges = 1;       ///< number of edges with this error of their own, not of a descendant
};

/// Criteria by which edges of a surface are split: flatness, view and errors.
class Criteria {
 public:
  Criteria(const Options& options, double diagonal, Margin& margin)
      : options_(options), view_(options.view ? *options.view : View{}), diagonal_(diagonal), margin_(margin) {
    forward_ = unit(view_.target - view_.eye);
    right_ = unit(cross(forward_, view_.up));
  }

  [[nodiscard]] bool has_flatness() const { return !options_.flatness.empty(); }
  [[nodiscard]] bool is_by_error() const { return options_.max_faces > 0 || threshold() > 0; }
  [[nodiscard]] bool is_uniform() const { return !has_flatness() && !options_.view && !is_by_error(); }
  [[nodiscard]] double flatness(int level) const {
    return options_.flatness[std::min(static_cast<size_t>(level), options_.flatness.size()) - 1];
  }
  [[nodiscard]] bool later_level_is_finer(int level) const {
    for (int later = level + 1; later <= options_.levels && has_flatness(); ++later)
      if (flatness(later) > flatness(level)) return true;
    return false;
  }
  /// Returns the error from which on an edge is split.
  [[nodiscard]] double threshold() const {
    const double pixels = options_.view ? view_.error_pixels : 0;
    return options_.tolerance > 0 && pixels > 0 ? 1 : std::max(options_.tolerance, pixels);
  }

  /// Returns the edges, among those of some faces, that flatness with growth selects.
  [[nodiscard]] std::set<uint32_t> curved_edges(const Surface& s, int level, const std::vector<uint32_t>& faces,
                                                const std::set<uint32_t>& among) const {
    std::set<uint32_t> curved = among;
    if (has_flatness()) std::erase_if(curved, [&](uint32_t e) { return !is_curved(s, e, flatness(level)); });
    std::set<uint32_t> edges = curved;
    if (options_.growth == Growth::faces)
      for (uint32_t f : faces)
        for (uint32_t side : s.sides[f])
          if (curved.contains(side)) edges.insert(s.sides[f].begin(), s.sides[f].end());
    if (options_.growth == Growth::vertices)
      for (uint32_t e : curved)
        for (uint32_t end : {s.edges[e].a, s.edges[e].b}) edges.insert(s.edges_at[end].begin(), s.edges_at[end].end());
    std::erase_if(edges, [&](uint32_t e) { return !among.contains(e); });
    return edges;
  }
  /// Returns the candidate edges: those that flatness and the view select.
  [[nodiscard]] std::set<uint32_t> candidates(const Surface& s, int level, const std::vector<uint32_t>& faces,
                                              const std::set<uint32_t>& among) const {
    std::set<uint32_t> edges = curved_edges(s, level, faces, among);
    std::erase_if(edges, [&](uint32_t e) { return !is_shown(s, e) || !is_long(s, e); });
    return edges;
  }

  /// Returns whether some face at the edge is not outside, and some face is not turned away.
  [[nodiscard]] bool is_shown(const Surface& s, uint32_t e) const {
    if (!options_.view) return true;
    double inside = -infinity;
    double away = infinity;
    for (uint32_t f : s.edges[e].faces) {
      const auto& [a, b, c] = s.faces[f];
      for (uint32_t v : s.faces[f]) inside = std::max(inside, clearance(s, v));
      away = std::min(away, cosine_away(1.0 / 3 * (s.at[a] + s.at[b] + s.at[c]), s.normal(f)));
    }
    return !margin_.is_less(inside, 0, 2) && margin_.is_less(away, least_away, s.slope);
  }

  /// Returns whether an edge looks long enough to be split, or so many times as long.
  [[nodiscard]] bool is_long(const Surface& s, uint32_t e, double times = 1) const {
    if (!options_.view || view_.edge_pixels == 0) return true;
    const Vec3d a = s.at[s.edges[e].a];
    const Vec3d b = s.at[s.edges[e].b];
    return !margin_.is_less(projected_length(a, b), times * view_.edge_pixels,
                            std::max(pixels_per_unit(a), pixels_per_unit(b)));
  }

  [[nodiscard]] double pixels_per_unit(Vec3d point) const {
    if (!options_.view) return 0;
    const double depth = is_perspective() ? std::max(near(), dot(forward_, point - view_.eye)) : distance();
    return view_.viewport[1] / (2 * tan_y() * depth);
  }

  [[nodiscard]] EdgeError error(const Surface& s, uint32_t e, Vec3d q) const {
    const double distance = s.deviation(e, q);
    double factor = pixels_per_unit(s.middle(e));
    const bool has_lights = options_.view && !view_.lights.empty();
    if (has_lights) factor *= light_weight(s, e, distance * factor);
    const double tolerated = options_.tolerance * diagonal_;
    if (tolerated > 0 && options_.view && view_.error_pixels > 0)
      factor = std::min(1 / tolerated, factor / view_.error_pixels);
    else if (tolerated > 0 || !options_.view)
      factor = 1 / diagonal_;
    return {factor * distance, factor * (1 + (has_lights ? 10 * distance * s.slope : 0)), s.edges[e].faces.size()};
  }

  /// Returns the least threshold at which the faces that splitting adds fit into the room. Equal errors go together.
  template <class Errors>
  [[nodiscard]] double threshold_within(const Errors& errors, uint64_t room) const {
    std::map<double, EdgeError, std::greater<>> sums;
    for (const auto& [key, error] : errors) {
      EdgeError& sum = sums.try_emplace(error.value, EdgeError{error.value, error.slope, 0, 0}).first->second;
      sum.faces += error.faces;
      sum.edges += error.edges;
    }
    for (auto at = sums.begin(); at != sums.end(); room -= at++->second.faces) {
      if (at->second.faces <= room) continue;
      // The result depends on how the first error that does not fit compares with zero and with all other errors.
      const double slope = at->second.edges > 1 ? infinity : at->second.slope;
      (void)margin_.is_less(0, at->first, slope);
      for (const auto& [key, error] : errors)
        if (error.value != at->first) (void)margin_.is_less(error.value, at->first, std::max(slope, error.slope));
      return at == sums.begin() ? infinity : std::prev(at)->first;
    }
    return threshold();
  }

 private:
  static constexpr double least_away = 1e-3;
  static Vec3d unit(Vec3d v) { return (1 / length(v)) * v; }
  [[nodiscard]] bool is_perspective() const { return view_.projection == Projection::perspective; }
  [[nodiscard]] double distance() const { return length(view_.target - view_.eye); }
  [[nodiscard]] double near() const { return view_.near > 0 ? view_.near : 1e-3 * distance(); }
  [[nodiscard]] double tan_y() const { return std::tan(view_.fov_y / 360 * std::numbers::pi); }

  [[nodiscard]] bool is_curved(const Surface& s, uint32_t e, double flat) const {
    constexpr double rounding = 4e-7;  // so that flat faces are not split at a threshold of 1
    if (s.edges[e].kind == Kind::smooth) return margin_.is_less(s.cosine(e), flat - rounding, s.slope);
    double least = 1;
    for (const uint32_t end : {s.edges[e].a, s.edges[e].b})
      if (const auto next = s.beyond(e, end))
        least = std::min(least, cosine_of_turn(s.at[s.edges[e].other(end)], s.at[end], s.at[*next]));
    return margin_.is_less(least, flat - rounding, s.slope);
  }

  /// Returns the signed depth of a vertex's ball inside of all five planes. Its radius is the vertex's longest edge.
  [[nodiscard]] double clearance(const Surface& s, uint32_t v) const {
    double radius = 0;
    for (uint32_t e : s.edges_at[v]) radius = std::max(radius, s.length(e));
    const Vec3d p = s.at[v] - view_.eye;
    const Vec3d up = cross(right_, forward_);
    const double tan_x = tan_y() * view_.viewport[0] / view_.viewport[1];
    double least = dot(p, forward_) - near();
    for (const auto& [side, tangent] :
         {std::pair(right_, tan_x), {-1.0 * right_, tan_x}, {up, tan_y()}, {-1.0 * up, tan_y()}})
      least = std::min(
          least, is_perspective() ? dot(p, unit(tangent * forward_ - side)) : tangent * distance() - dot(p, side));
    return least + radius;
  }

  [[nodiscard]] double cosine_away(Vec3d point, Vec3d normal) const {
    return dot(is_perspective() ? unit(point - view_.eye) : forward_, normal);
  }

  /// Returns the length of a segment in pixels, clipped at the near plane.
  [[nodiscard]] double projected_length(Vec3d a, Vec3d b) const {
    const double depth_a = dot(forward_, a - view_.eye) - near();
    const double depth_b = dot(forward_, b - view_.eye) - near();
    if (depth_a < 0 && depth_b < 0) return 0;
    if (depth_a < 0) a += depth_a / (depth_a - depth_b) * (b - a);
    if (depth_b < 0) b += depth_b / (depth_b - depth_a) * (a - b);
    const Vec3d off = pixels_per_unit(a) * (a - view_.eye) - pixels_per_unit(b) * (b - view_.eye);
    return std::hypot(dot(right_, off), dot(cross(right_, forward_), off));
  }

  /// Returns the weight of a deviation in a lit picture. The formula and its constants are those of core/lighting.h.
  [[nodiscard]] double light_weight(const Surface& s, uint32_t e, double pixels) const {
    std::vector<double> brightness, slope, facing;
    std::vector<bool> is_away;
    for (uint32_t f : s.edges[e].faces) {
      double sum = 0;
      Vec3d gradient;
      for (const Vec3d& light : view_.lights) {
        const double cosine = dot(s.normal(f), unit(light));
        if (margin_.is_less(cosine, 0, s.slope)) continue;
        sum += cosine;
        gradient += unit(light) - cosine * s.normal(f);
      }
      const double away = cosine_away(s.middle(e), s.normal(f));
      slope.push_back(margin_.is_less(sum, 1, s.slope) ? length(gradient) : 0);
      brightness.push_back(std::min(sum, 1.0));
      facing.push_back(std::max(0.0, -away));
      is_away.push_back(!margin_.is_less(away, least_away, s.slope));
    }
    margin_.is_disputed |= s.edges[e].kind == Kind::shared && options_.scheme == Scheme::in_place;
    const size_t other = s.joins(e) ? 1 : 0;  // one face stands for both where they are not joined
    const double shading = 1.3 * (2 * std::abs(brightness[0] - brightness[other]) + (slope[0] + slope[other]) / 2) *
                           std::sqrt((facing[0] + facing[other]) / 2);
    if (s.joins(e) && is_away[0] == is_away[1]) return std::hypot(0.4, shading);
    const double contrast = 0.3 + 0.7 * brightness[is_away[0] ? other : 0];
    const double seen = projected_length(s.at[s.edges[e].a], s.at[s.edges[e].b]);
    return std::hypot(0.4, shading, 0.8 * contrast * std::sqrt(seen / std::max(1.0, pixels)));
  }

  const Options& options_;
  const View view_;
  const double diagonal_;
  Margin& margin_;
  Vec3d forward_, right_;
};

}  // namespace papilio::reference
