#include "detail/distant_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "detail/folds.h"
#include "detail/residual_frames.h"

namespace papilio {
namespace {

constexpr int most_passes = 8;
/// Share of a move's length by which a residual with one part may miss its point.
constexpr double largest_miss = 0.5;
/// Distance that a move may leave, as a share of the one it was made for: faces at a tip are first farther from it than
/// those that cut it off, until their other corners move too.
constexpr double largest_harm = 1.2;

class DistantPoints {
 public:
  DistantPoints(ResidualFit& fit, const OriginalSurface& original, const DistantBounds& bounds, const Poller& poller)
      : fit_(fit),
        original_(original),
        bounds_(bounds),
        poller_(poller),
        level_(fit.level(fit.level_count() - 1)),
        first_(level_.topology().vertex_count),
        surface_(fit.surface(fit.level_count())),
        normals_(residual_normals(level_, surface_.positions.data())),
        residuals_(fit.residuals(fit.level_count() - 1)),
        may_move_(surface_.positions.size()),
        near_face_(original.mesh().positions.size() + original.mesh().topology.face_count(), none) {
    std::fill(may_move_.begin() + first_, may_move_.end(), true);
    for (const uint32_t e : level_.curve_edges()) may_move_[first_ + e] = false;
  }

  void run() {
    for (int pass = 0; pass < most_passes; ++pass) {
      find_distant();
      if (distant_.empty() || !move_vertices()) return;
      take_back_harm();
    }
  }

 private:
  struct Distant {
    double squared_distance;
    uint32_t point;
    uint32_t face;  ///< nearest face of the surface
  };
  struct Move {
    uint32_t vertex;
    Distant distant;
    int32_t along_normal;                              ///< residual before
    std::optional<std::array<int32_t, 2>> tangential;  ///< residual before
    std::vector<uint32_t> faces = {};                  ///< round the vertex
  };

  [[nodiscard]] Vec3d point(uint32_t number) const {
    const Mesh& mesh = original_.mesh();
    const auto vertices = static_cast<uint32_t>(mesh.positions.size());
    if (number < vertices) return to_double(mesh.positions[number]);
    const auto [a, b, c] = original_.tree().corners(number - vertices);
    return (1 / 3.0) * (a + b + c);
  }

  /// Finds the distant points, the farthest first. After the first time only those are measured whose nearest face has
  /// moved, or that were distant: others are no farther than before.
  void find_distant() {
    const SurfaceTree tree(surface_);
    for (const Distant& d : std::exchange(distant_, {})) near_face_[d.point] = none;
    for (uint32_t p = 0; p < near_face_.size(); ++p) {
      poller_.step();
      uint32_t& face = near_face_[p];
      if (face != none && !is_near_moved_[face]) continue;
      const Nearest near = tree.nearest(point(p));
      face = near.face;
      if (near.squared_distance > bounds_.most * bounds_.most) distant_.push_back({near.squared_distance, p, face});
    }
    std::ranges::sort(distant_, [](const Distant& a, const Distant& b) {
      return a.squared_distance != b.squared_distance ? a.squared_distance > b.squared_distance : a.point < b.point;
    });
  }

  /// Moves for each distant point, unless its nearest face has moved, the nearest corner of that face. Returns whether
  /// any has moved.
  bool move_vertices() {
    moved_.clear();
    std::vector<bool> is_used(may_move_.size());
    for (const Distant& d : distant_) {
      const Triangle& corners = surface_.triangles[d.face];
      if (std::ranges::any_of(corners, [&](uint32_t v) { return is_used[v]; })) continue;
      const Vec3d to = point(d.point);
      double least = std::numeric_limits<double>::infinity();
      uint32_t nearest = none;
      for (const uint32_t v : corners) {
        const Vec3d way = to - to_double(surface_.positions[v]);
        if (may_move_[v] && !refused_.contains({v, d.point}) && dot(way, way) < least)
          least = dot(way, way), nearest = v;
      }
      if (nearest == none || !move(nearest, d)) continue;
      may_move_[nearest] = false;
      for (const uint32_t v : corners) is_used[v] = true;
    }
    return !moved_.empty();
  }

  /// Changes the residual of a vertex so that it comes to lie at a distant point. Returns whether it has moved.
  bool move(uint32_t v, const Distant& distant) {
    const uint32_t e = v - first_;
    const Vec3d way = point(distant.point) - to_double(surface_.positions[v]);
    const auto steps = [&](Vec3f direction) {
      return static_cast<int32_t>(std::lround(dot(way, to_double(direction)) / residuals_.step));
    };
    if (2 * length(way) > static_cast<double>(largest_residual) * static_cast<double>(residuals_.step)) return false;
    const int32_t up = steps(normals_[e]);
    const Vec3d missed = way - up * static_cast<double>(residuals_.step) * to_double(normals_[e]);
    const auto free = residuals_.tangential.find(e);
    const bool was_free = free != residuals_.tangential.end();
    const bool is_free = was_free || length(missed) > largest_miss * length(way);
    if (std::abs(residuals_.along_normal[e] + up) > largest_residual || (up == 0 && !is_free)) return false;
    moved_.push_back({v, distant, residuals_.along_normal[e], was_free ? std::optional(free->second) : std::nullopt});
    residuals_.along_normal[e] += up;
    if (is_free) {
      const Tangents tangents = residual_tangents(level_.topology(), surface_.positions.data(), e, normals_[e]);
      std::array<int32_t, 2>& parts = residuals_.tangential[e];
      parts = {std::clamp(parts[0] + steps(tangents.along), -largest_residual, largest_residual),
               std::clamp(parts[1] + steps(tangents.across), -largest_residual, largest_residual)};
    }
    return true;
  }

  /// Restores the vertex's residual, and refuses its move to the point.
  void take_back(const Move& move) {
    may_move_[move.vertex] = true;
    refused_.emplace(move.vertex, move.distant.point);
    const uint32_t e = move.vertex - first_;
    residuals_.along_normal[e] = move.along_normal;
    if (move.tangential)
      residuals_.tangential[e] = *move.tangential;
    else
      residuals_.tangential.erase(e);
  }

  [[nodiscard]] TriangleCorners corners(uint32_t face) const {
    const Triangle& v = surface_.triangles[face];
    return {to_double(surface_.positions[v[0]]), to_double(surface_.positions[v[1]]),
            to_double(surface_.positions[v[2]])};
  }
  [[nodiscard]] bool is_fold(uint32_t face) const {
    return papilio::is_fold(original_, corners(face), bounds_.sheet_reach);
  }

  /// Applies the moves, and takes those back round which a face is a fold that was none before, or a point of either
  /// surface is too far from the other one.
  void take_back_harm() {
    std::vector<uint32_t> move_at(surface_.positions.size(), none);
    for (uint32_t i = 0; i < moved_.size(); ++i) move_at[moved_[i].vertex] = i;
    is_near_moved_.assign(surface_.triangles.size(), false);
    was_fold_.assign(surface_.triangles.size(), false);
    for (uint32_t f = 0; f < surface_.triangles.size(); ++f)
      for (const uint32_t v : surface_.triangles[f]) {
        if (move_at[v] == none) continue;
        moved_[move_at[v]].faces.push_back(f);
        if (!is_near_moved_[f]) was_fold_[f] = is_fold(f);
        is_near_moved_[f] = true;
      }
    points_at_.clear();
    for (uint32_t p = 0; p < near_face_.size(); ++p)
      if (is_near_moved_[near_face_[p]]) points_at_.emplace_back(near_face_[p], p);
    std::ranges::sort(points_at_);
    for (bool is_harmed = true; is_harmed;) {
      poller_.now();
      fit_.set_last_residuals(residuals_);
      surface_ = fit_.surface(fit_.level_count());
      const auto harmful =
          std::partition(moved_.begin(), moved_.end(), [&](const Move& move) { return !is_harmful(move); });
      std::for_each(harmful, moved_.end(), [&](const Move& move) { take_back(move); });
      is_harmed = harmful != moved_.end();
      moved_.erase(harmful, moved_.end());
    }
  }

  [[nodiscard]] bool is_harmful(const Move& move) const {
    if (std::ranges::any_of(move.faces, [&](uint32_t f) { return !was_fold_[f] && is_fold(f); })) return true;
    const double most = largest_harm * largest_harm * move.distant.squared_distance;
    const auto is_far = [&](Vec3d p) { return original_.tree().nearest(p).squared_distance > most; };
    for (const uint32_t f : move.faces) {
      const auto [a, b, c] = corners(f);
      if (is_far((1 / 3.0) * (a + b + c)) || is_far(0.5 * (a + b)) || is_far(0.5 * (b + c)) || is_far(0.5 * (c + a)))
        return true;
      for (auto at = std::ranges::lower_bound(points_at_, std::pair{f, 0U}); at != points_at_.end() && at->first == f;
           ++at)
        if (std::ranges::none_of(
                move.faces, [&](uint32_t near) { return squared_distance(point(at->second), corners(near)) <= most; }))
          return true;
    }
    return false;
  }

  ResidualFit& fit_;
  const OriginalSurface& original_;
  DistantBounds bounds_;
  const Poller& poller_;
  const DetailLevel& level_;
  uint32_t first_;  ///< first new vertex of the last level
  TriangleMesh surface_;
  Buffer<Vec3f> normals_;  // [E] of the last level's residuals
  Residuals residuals_;
  std::vector<bool> may_move_;                       // [V]
  std::set<std::pair<uint32_t, uint32_t>> refused_;  // vertices and points they must not move to
  std::vector<uint32_t> near_face_;  // [points] nearest face of the surface; `none` where it must be found
  std::vector<bool> is_near_moved_;  // [F] whether a corner may have moved since the points were measured
  std::vector<bool> was_fold_;       // [F] whether a face at a moved vertex was a fold before
  std::vector<std::pair<uint32_t, uint32_t>> points_at_;  // faces at moved vertices and points nearest to them, sorted
  std::vector<Distant> distant_;
  std::vector<Move> moved_;
};

}  // namespace

void reach_distant_points(ResidualFit& fit, const OriginalSurface& original, const DistantBounds& bounds,
                          const Poller& poller) {
  DistantPoints(fit, original, bounds, poller).run();
}

}  // namespace papilio
