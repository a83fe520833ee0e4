#include "detail/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "detail/residual_frames.h"
#include "detail/surface_walk.h"

namespace papilio {
namespace {

/// Upper bound of the distance from a line's hit to the expected vertex, in lengths of the edge.
constexpr double reach = 2;
/// Lower bound of a new face's area along the original's normal, a share of a quarter of its parent's area. Below it,
/// the face counts as turned over.
constexpr double least_area = 0.2;
constexpr int untangling_passes = 6;

class Placement {
 public:
  Placement(const OriginalSurface& original, const LiftedBase& base)
      : original_(original), base_(base), positions_(base.mesh.positions) {
    const Topology& t = base.mesh.topology;
    for (uint32_t v = 0; v < positions_.size(); ++v) face_.push_back(original.face_at(base.vertex[v]));
    for (uint32_t e = 0; e < t.edge_count(); ++e)
      if (t.kind[e] == EdgeKind::crease) face_[t.origin[t.half_edge[e]]] = face_[t.tip(t.half_edge[e])] = none;
    for (uint32_t v = 0; v < positions_.size(); ++v) normal_.push_back(normal_at(face_[v], to_double(positions_[v])));
    drift_.resize(positions_.size());
  }

  /// Places the new vertices of a level.
  Residuals place(const DetailLevel& level, float step) {
    level_ = &level;
    topology_ = &level.topology();
    made_ = {.step = step,
             .along_normal = Buffer<int32_t>(topology_->edge_count()),
             .across = Buffer<int32_t>(level.curve_edges().size())};
    is_on_curve_.assign(topology_->edge_count(), false);
    for (const uint32_t e : level.curve_edges()) is_on_curve_[e] = true;
    directions_ = residual_normals(level, positions_.data());
    level.predict(positions_);
    predicted_ = positions_;
    for (auto* array : {&normal_, &drift_}) array->resize(positions_.size());
    face_.resize(positions_.size());
    for (uint32_t e = 0; e < topology_->edge_count(); ++e)
      if (!is_on_curve(e)) find_target(e);
    for (uint32_t c = 0; c < level.curve_edges().size(); ++c) find_target_on_curve(c);
    displace(level, directions_, made_, positions_);
    for (int pass = 0; pass < untangling_passes && find_turned(); ++pass)
      for (uint32_t e = 0; e < topology_->edge_count(); ++e)
        if (is_bad_[e]) untangle(e);
    return std::move(made_);
  }

 private:
  struct Ends {
    uint32_t a, b;
    double length;
    Vec3d expected;  ///< lifted place, moved by the mean drift of both ends
  };
  [[nodiscard]] Ends ends(uint32_t e) const {
    const uint32_t h = topology_->half_edge[e];
    const uint32_t a = topology_->origin[h];
    const uint32_t b = topology_->tip(h);
    const Vec3d pa = to_double(positions_[a]);
    const Vec3d pb = to_double(positions_[b]);
    return {a, b, length(pb - pa), to_double(lifted(e).point) + 0.5 * (to_double(drift_[a]) + to_double(drift_[b]))};
  }
  [[nodiscard]] bool is_on_curve(uint32_t e) const { return is_on_curve_[e]; }
  /// Returns the original's curves, or its seams, for an edge on one.
  [[nodiscard]] const OriginalCurves& curves_of(uint32_t e) const {
    return topology_->kind[e] == EdgeKind::smooth ? original_.seams() : original_.curves();
  }
  /// Returns the original's normal; zero at creases (no face), where there are two.
  [[nodiscard]] Vec3f normal_at(uint32_t face, Vec3d point) const {
    return face == none ? Vec3f{} : to_float(original_.normal(face, point));
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
      if (start == none) continue;
      const auto hit = walk_to_line(original_.mesh(), start, point, direction);
      if (!hit) continue;
      const double off = length(point + hit->offset * direction - edge.expected);
      if (off < least) least = off, best = hit;
    }
    if (best) return set_target(e, point + best->offset * direction, best->face, false);
    const Nearest near = original_.tree().nearest(point, edge.length / 2, direction);
    const Vec3d off = near.point - point;
    if (near.face != none && length(off - dot(off, direction) * direction) <= made_.step)
      set_target(e, near.point, near.face, false);
    else
      set_free_target(e, edge, edge.expected, original_.tree().unit_normal(lifted(e).face));
  }

  /// Sets the target to the intersection of the original's curve with the plane across the edge, through the predicted
  /// vertex.
  void find_target_on_curve(uint32_t c) {
    const uint32_t e = level_->curve_edges()[c];
    const Ends edge = ends(e);
    const Vec3d point = to_double(predicted_[vertex(e)]);
    const Nearest start = curves_of(e).nearest(to_double(lifted(e).point));
    const Tangents tangents = residual_tangents(*topology_, predicted_.data(), e, directions_[e]);
    const auto met = curves_of(e).meet(start.face, start.point, point, to_double(tangents.along), edge.length);
    if (!met || length(*met - edge.expected) > reach * edge.length) return set_free_target(e, edge, edge.expected, {});
    set_target(e, *met, lifted(e).face, false);
    made_.across[c] = steps(*met - to_double(predicted_[vertex(e)]), tangents.across);
  }

  /// Sets the target to the original's place nearest to `near`, on a curve if the edge is on one, else on a sheet of
  /// about this normal; or to the lifted place if there is none.
  void set_free_target(uint32_t e, const Ends& edge, Vec3d near, Vec3d normal) {
    if (is_on_curve(e)) return set_target(e, curves_of(e).nearest(near).point, lifted(e).face, true);
    const Nearest found = original_.tree().nearest(near, edge.length / 2, normal);
    if (found.face != none)
      set_target(e, found.point, found.face, true);
    else
      set_target(e, to_double(lifted(e).point), lifted(e).face, true);
  }

  void set_target(uint32_t e, Vec3d target, uint32_t face, bool is_free) {
    const uint32_t v = vertex(e);
    const Vec3d move = target - to_double(predicted_[v]);
    made_.along_normal[e] = steps(move, directions_[e]);
    if (is_free) {
      const Tangents tangents = residual_tangents(*topology_, predicted_.data(), e, directions_[e]);
      made_.tangential[e] = {steps(move, tangents.along), steps(move, tangents.across)};
      if (is_on_curve(e)) made_.across[number_on_curves(e)] = 0;
    }
    face_[v] = topology_->kind[e] == EdgeKind::crease ? none : face;
    normal_[v] = normal_at(face_[v], target);
    drift_[v] = to_float(target - to_double(lifted(e).point));
  }

  [[nodiscard]] size_t number_on_curves(uint32_t e) const {
    const std::span<const uint32_t> edges = level_->curve_edges();
    return static_cast<size_t>(std::ranges::lower_bound(edges, e) - edges.begin());
  }
  [[nodiscard]] int32_t steps(Vec3d move, Vec3f direction) const {
    const double steps = dot(move, to_double(direction)) / made_.step;
    return static_cast<int32_t>(std::lround(std::clamp<double>(steps, -largest_residual, largest_residual)));
  }

  using Corners = std::array<uint32_t, 3>;  // vertices of a next level's face
  struct Children {
    std::array<Corners, 4> corners;
    Vec3d parent;  ///< normal of the split face, as long as twice its area
  };
  [[nodiscard]] Children children(uint32_t f) const {
    const uint32_t* v = &topology_->origin[size_t{3} * f];
    const uint32_t* e = &topology_->edge[size_t{3} * f];
    const Corners m{vertex(e[0]), vertex(e[1]), vertex(e[2])};
    return {{Corners{v[0], m[0], m[2]}, Corners{m[0], v[1], m[1]}, Corners{m[2], m[1], v[2]}, m},
            area_normal({v[0], v[1], v[2]})};
  }

  /// Marks the edges at whose new vertices faces are turned over. Returns whether there are any.
  bool find_turned() {
    is_bad_.assign(topology_->edge_count(), false);
    bool found = false;
    for (uint32_t f = 0; f < topology_->face_count(); ++f) {
      const uint32_t* e = &topology_->edge[size_t{3} * f];
      const Children of_face = children(f);
      for (const Corners& child : of_face.corners) {
        if (surplus(child, of_face.parent) > 0) continue;
        found = true;
        for (uint32_t i = 0; i < 3; ++i)
          if (std::ranges::find(child, vertex(e[i])) != child.end()) is_bad_[e[i]] = true;
      }
    }
    return found;
  }

  /// Moves the new vertex of an edge between its neighbours, as far as that turns faces back. Takes the best of all
  /// roundings to steps.
  void untangle(uint32_t e) {
    const uint32_t v = vertex(e);
    Vec3d middle;
    double count = 0;
    for_each_child_at(e, [&](const Corners& child, Vec3d) {
      for (const uint32_t w : child)
        if (w != v) middle += to_double(positions_[w]), ++count;
    });
    middle = (1 / count) * middle;
    Placed best = placed(e);
    double most = surplus_at(e);
    const Ends edge = ends(e);
    const Vec3d start = to_double(best.position);
    for (int target = 0; target < 3; ++target) {
      if (target == 0)
        set_free_target(e, edge, edge.expected, original_.tree().unit_normal(lifted(e).face));
      else
        set_free_target(e, edge, target == 1 ? middle : 0.5 * (middle + start), to_double(directions_[e]));
      const Placed rounded = placed(e);
      const Tangents tangents = residual_tangents(*topology_, predicted_.data(), e, directions_[e]);
      for (int i = 0; i < 9; ++i) {
        const std::array<int32_t, 2> off{i % 3 - 1, is_on_curve(e) ? 0 : i / 3 - 1};
        for (size_t k = 0; k < 2; ++k)
          made_.tangential[e][k] = std::clamp(rounded.tangential->at(k) + off[k], -largest_residual, largest_residual);
        const auto& parts = made_.tangential[e];
        positions_[v] = predicted_[v] + made_.step * (static_cast<float>(made_.along_normal[e]) * directions_[e] +
                                                      static_cast<float>(parts[0]) * tangents.along +
                                                      static_cast<float>(parts[1]) * tangents.across);
        if (const double sum = surplus_at(e); sum > most) most = sum, best = placed(e);
      }
    }
    put_back(e, best);
  }

  /// Position of a new vertex, and its residual.
  struct Placed {
    Vec3f position, normal, drift;
    uint32_t face;
    int32_t along_normal, across;
    std::optional<std::array<int32_t, 2>> tangential;
  };
  [[nodiscard]] Placed placed(uint32_t e) const {
    const uint32_t v = vertex(e);
    const auto found = made_.tangential.find(e);
    return {positions_[v],
            normal_[v],
            drift_[v],
            face_[v],
            made_.along_normal[e],
            is_on_curve(e) ? made_.across[number_on_curves(e)] : 0,
            found == made_.tangential.end() ? std::nullopt : std::optional(found->second)};
  }
  void put_back(uint32_t e, const Placed& place) {
    const uint32_t v = vertex(e);
    positions_[v] = place.position;
    normal_[v] = place.normal;
    drift_[v] = place.drift;
    face_[v] = place.face;
    made_.along_normal[e] = place.along_normal;
    if (is_on_curve(e)) made_.across[number_on_curves(e)] = place.across;
    if (place.tangential)
      made_.tangential[e] = *place.tangential;
    else
      made_.tangential.erase(e);
  }

  /// Calls visit(corners, parent's normal) for the faces of the next level at the new vertex of an edge.
  template <class Visit>
  void for_each_child_at(uint32_t e, const Visit& visit) const {
    const uint32_t h = topology_->half_edge[e];
    for (const uint32_t side : {h, topology_->twin[h]}) {
      if (side == none) continue;
      const Children of_face = children(Topology::face(side));
      for (const Corners& child : of_face.corners)
        if (std::ranges::find(child, vertex(e)) != child.end()) visit(child, of_face.parent);
    }
  }
  /// Returns the sum of surplus() over the turned faces at the new vertex of an edge; 0 without turned faces.
  [[nodiscard]] double surplus_at(uint32_t e) const {
    double sum = 0;
    for_each_child_at(e, [&](const Corners& child, Vec3d parent) { sum += std::min(surplus(child, parent), 0.0); });
    return sum;
  }

  [[nodiscard]] Vec3d area_normal(const Corners& v) const {
    const Vec3d a = to_double(positions_[v[0]]);
    return cross(to_double(positions_[v[1]]) - a, to_double(positions_[v[2]]) - a);
  }
  /// Returns the area of a face along the original's normals, or along the parent's if all vertices are on creases,
  /// less its lower bound. A face without a positive surplus counts as turned over.
  [[nodiscard]] double surplus(const Corners& face, Vec3d parent) const {
    Vec3d normal = to_double(normal_[face[0]]) + to_double(normal_[face[1]]) + to_double(normal_[face[2]]);
    if (length(normal) == 0) normal = parent;
    const double size = length(normal);
    return size > 0 ? dot(area_normal(face), (1 / size) * normal) - least_area / 4 * length(parent) : 0;
  }

  const OriginalSurface& original_;
  const LiftedBase& base_;
  Buffer<Vec3f> positions_;
  std::vector<uint32_t> face_;  // [V] face of the original at the vertex; `none` on creases
  Buffer<Vec3f> normal_;        // [V] normal of the original at the vertex; zero on creases
  Buffer<Vec3f> drift_;         // [V] vector from the lifted place to the chosen one

  const DetailLevel* level_ = nullptr;  // current level
  const Topology* topology_ = nullptr;
  Residuals made_;
  Buffer<Vec3f> directions_;       // [E]
  Buffer<Vec3f> predicted_;        // [V + E]
  std::vector<bool> is_on_curve_;  // [E] whether the edge is on a curve or seam
  std::vector<bool> is_bad_;       // [E] whether a face at the new vertex is turned over
};

}  // namespace

float StepSchedule::of(int level, int levels) const {
  return last * std::pow(ratio, static_cast<float>(levels - 1 - level));
}

PlacedLevels place_on_original(const OriginalSurface& original, const LiftedBase& base, int levels,
                               const StepSchedule& steps, const Poller& poller) {
  PlacedLevels placed;
  Placement placement(original, base);
  DetailLevel level(base.mesh.topology, base.seams);
  for (int l = 0; l < levels; ++l) {
    poller.now();
    placed.residuals.push_back(placement.place(level, steps.of(l, levels)));
    DetailLevel next = level.next();
    placed.levels.push_back(std::move(level));
    level = std::move(next);
  }
  placed.last = level.topology();
  return placed;
}

}  // namespace papilio
