#include "detail/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "detail/residual_frames.h"
#include "detail/surface_walk.h"

namespace papilio {
namespace {

/// A line's hit is taken within this share of the edge's length of where the vertex is expected.
constexpr double reach = 0.3;
/// A new face is turned over, or nearly, if its area seen along the original's normal is less than this share of a
/// quarter of its parent's area.
constexpr double least_area = 0.3;
/// Rounds of mending faces that are turned over.
constexpr int mending_rounds = 3;
/// From this level on the middle of an edge lies near its place on the original.
constexpr uint32_t level_of_small_edges = 2;

class Placement {
 public:
  Placement(const OriginalSurface& original, const LiftedBase& base)
      : original_(original), base_(base), positions_(base.mesh.positions) {
    for (uint32_t v = 0; v < positions_.size(); ++v) {
      face_.push_back(original.face_at(base.vertex[v]));
      normal_.push_back(to_float(original.normal(face_[v], to_double(positions_[v]))));
    }
    drift_.resize(positions_.size());
  }

  /// Places the new vertices of a level.
  Residuals place(const DetailLevel& level, float step) {
    level_ = &level;
    topology_ = &level.topology();
    made_ = {.step = step, .along_normal = Buffer<int32_t>(topology_->edge_count())};
    directions_ = residual_normals(*topology_, positions_.data());
    level.predict(positions_);
    predicted_ = positions_;
    for (auto* array : {&normal_, &drift_}) array->resize(positions_.size());
    face_.resize(positions_.size());
    for (uint32_t e = 0; e < topology_->edge_count(); ++e) find_target(e);
    for (int round = 0;; ++round) {
      positions_ = predicted_;
      displace(level, directions_, made_, positions_);
      if (round == mending_rounds || !mend_folds(round)) return std::move(made_);
    }
  }

 private:
  struct Ends {
    uint32_t a, b;
    double length;
    Vec3d middle;
    Vec3d expected;  ///< the lifted place, moved as far as both ends are from theirs
  };
  [[nodiscard]] Ends ends(uint32_t e) const {
    const uint32_t h = topology_->half_edge[e];
    const uint32_t a = topology_->origin[h];
    const uint32_t b = topology_->tip(h);
    const Vec3d pa = to_double(positions_[a]);
    const Vec3d pb = to_double(positions_[b]);
    return {a, b, length(pb - pa), 0.5 * (pa + pb),
            to_double(lifted(e).point) + 0.5 * (to_double(drift_[a]) + to_double(drift_[b]))};
  }
  [[nodiscard]] const OriginalPlace& lifted(uint32_t e) const { return base_.places[level_->number()][e]; }
  [[nodiscard]] uint32_t vertex(uint32_t e) const { return topology_->vertex_count + e; }

  void find_target(uint32_t e) {
    const Ends edge = ends(e);
    const Vec3d point = to_double(predicted_[vertex(e)]);
    const Vec3d direction = to_double(directions_[e]);
    std::optional<LineHit> best;
    double least = reach * edge.length;
    for (const uint32_t start : {lifted(e).face, face_[edge.a], face_[edge.b]}) {
      const auto hit = walk_to_line(original_.mesh(), start, point, direction);
      if (!hit) continue;
      const double off = length(point + hit->offset * direction - edge.expected);
      if (off < least) least = off, best = hit;
    }
    if (best)
      set_target(e, point + best->offset * direction, best->face, false);
    else
      set_free_target(e, edge, edge.expected, original_.tree().unit_normal(lifted(e).face));
  }

  /// Sets the place of the original nearest to a point, on a sheet with about this normal; else the lifted one.
  void set_free_target(uint32_t e, const Ends& edge, Vec3d near, Vec3d normal) {
    const Nearest found = original_.tree().nearest(near, edge.length / 2, normal);
    if (found.face != none)
      set_target(e, found.point, found.face, true);
    else
      set_target(e, to_double(lifted(e).point), lifted(e).face, true);
  }

  void set_target(uint32_t e, Vec3d target, uint32_t face, bool is_free) {
    const uint32_t v = vertex(e);
    const Vec3d move = target - to_double(predicted_[v]);
    const auto part = [&](Vec3f direction) {
      const double steps = dot(move, to_double(direction)) / made_.step;
      return static_cast<int32_t>(std::lround(std::clamp<double>(steps, -largest_residual, largest_residual)));
    };
    made_.along_normal[e] = part(directions_[e]);
    if (is_free) {
      const Tangents tangents = residual_tangents(*topology_, predicted_.data(), e, directions_[e]);
      made_.tangential[e] = {part(tangents.along), part(tangents.across)};
    }
    face_[v] = face;
    normal_[v] = to_float(original_.normal(face, target));
    drift_[v] = to_float(target - to_double(lifted(e).point));
  }

  /// Frees the new vertices of faces that are turned over: first to where they are expected, then, with those of the
  /// whole parent, to the middles of their edges. Returns whether there were any.
  bool mend_folds(int round) {
    std::vector<bool> is_bad(topology_->edge_count());
    bool found = false;
    for (uint32_t f = 0; f < topology_->face_count(); ++f) {
      const uint32_t* v = &topology_->origin[size_t{3} * f];
      const uint32_t* e = &topology_->edge[size_t{3} * f];
      const std::array<uint32_t, 3> m{vertex(e[0]), vertex(e[1]), vertex(e[2])};
      const double least = least_area / 4 * length(area_normal({v[0], v[1], v[2]}));
      for (const std::array<uint32_t, 3>& child :
           {std::array{v[0], m[0], m[2]}, std::array{m[0], v[1], m[1]}, std::array{m[2], m[1], v[2]}, m}) {
        if (!is_turned(child, least)) continue;
        found = true;
        for (uint32_t i = 0; i < 3; ++i)
          if (round > 0 || std::ranges::find(child, m[i]) != child.end()) is_bad[e[i]] = true;
      }
    }
    for (uint32_t e = 0; e < topology_->edge_count() && found; ++e) {
      if (!is_bad[e]) continue;
      const Ends edge = ends(e);
      if (round > 0 && level_->number() >= level_of_small_edges)
        set_free_target(e, edge, edge.middle, to_double(directions_[e]));
      else
        set_free_target(e, edge, edge.expected, original_.tree().unit_normal(lifted(e).face));
    }
    return found;
  }

  [[nodiscard]] Vec3d area_normal(const std::array<uint32_t, 3>& v) const {
    const Vec3d a = to_double(positions_[v[0]]);
    return cross(to_double(positions_[v[1]]) - a, to_double(positions_[v[2]]) - a);
  }
  [[nodiscard]] bool is_turned(const std::array<uint32_t, 3>& face, double least) const {
    const Vec3d normal = to_double(normal_[face[0]]) + to_double(normal_[face[1]]) + to_double(normal_[face[2]]);
    return !(dot(area_normal(face), normal) > least * length(normal));
  }

  const OriginalSurface& original_;
  const LiftedBase& base_;
  Buffer<Vec3f> positions_;
  std::vector<uint32_t> face_;  // [V] of the original, at the vertex's place
  Buffer<Vec3f> normal_;        // [V] of the original there
  Buffer<Vec3f> drift_;         // [V] from the lifted place to the chosen one

  const DetailLevel* level_ = nullptr;  // at hand
  const Topology* topology_ = nullptr;
  Residuals made_;
  Buffer<Vec3f> directions_;  // [E]
  Buffer<Vec3f> predicted_;   // [V + E]
};

}  // namespace

float StepSchedule::of(int level, int levels) const {
  return last * std::pow(ratio, static_cast<float>(levels - 1 - level));
}

PlacedLevels place_on_original(const OriginalSurface& original, const LiftedBase& base, int levels,
                               const StepSchedule& steps, const std::function<void()>& poll) {
  PlacedLevels placed;
  Placement placement(original, base);
  DetailLevel level(base.mesh.topology);
  for (int l = 0; l < levels; ++l) {
    if (poll) poll();
    placed.residuals.push_back(placement.place(level, steps.of(l, levels)));
    DetailLevel next = level.next();
    placed.levels.push_back(std::move(level));
    level = std::move(next);
  }
  placed.last = level.topology();
  return placed;
}

}  // namespace papilio
