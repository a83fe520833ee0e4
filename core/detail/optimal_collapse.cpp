#include "detail/optimal_collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "detail/quadric.h"
#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

/// Weight of a boundary's plane, per squared length of its edge, relative to a face's area.
constexpr double boundary_weight = 100;
/// Lower bound of the cosine between a face's normals before and after a collapse.
constexpr double least_cosine_of_turn = 0.2;
/// Number of changed faces beyond which a point stays at its face if that remains near enough, as in the middle of a
/// lid: looking at all faces for each of their points takes the square of their number.
constexpr size_t many_faces = 64;
/// Lower bound of the queue's length at which stale collapses are dropped.
constexpr size_t least_to_drop = 10'000;

struct PairCollapse {
  double cost;
  Vec3d place;  ///< position of the merged vertex
  uint32_t kept, removed;
  uint32_t age;  ///< sum of both vertices' ages when computed; the collapse is stale if it has changed
};
/// Compares collapses for a heap with the cheapest at its top. Ties go by index, so that the result does not depend on
/// the standard library.
bool is_costlier(const PairCollapse& a, const PairCollapse& b) {
  if (a.cost != b.cost) return a.cost > b.cost;
  return a.kept != b.kept ? a.kept > b.kept : a.removed > b.removed;
}

/// Returns faces with one vertex per fan: a non-manifold surface falls into manifold sheets.
std::vector<Triangle> cut_into_sheets(const Topology& t) {
  DisjointSets fans(t.half_edge_count());
  for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
    if (t.twin[h] == none) continue;
    fans.join(h, Topology::next(t.twin[h]));
    fans.join(Topology::next(h), t.twin[h]);
  }
  std::vector<uint32_t> vertex(t.half_edge_count());
  std::vector<Triangle> faces(t.face_count());
  uint32_t count = 0;
  for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
    vertex[h] = fans.find(h) == h ? count++ : vertex[fans.find(h)];
    faces[h / 3][h % 3] = vertex[h];
  }
  return faces;
}

class Simplifier {
 public:
  Simplifier(const Mesh& mesh, Quadrics quadrics, double largest, const Poller& poller)
      : poller_(poller),
        quadrics_are_(quadrics),
        squared_largest_(largest * largest),
        faces_(cut_into_sheets(mesh.topology)),
        face_count_(mesh.topology.face_count()) {
    const Topology& t = mesh.topology;
    for (uint32_t h = 0; h < t.half_edge_count(); ++h)
      if (corner(h) == places_.size()) places_.push_back(to_double(mesh.positions[t.origin[h]]));
    if (std::isfinite(largest)) {
      points_ = places_;
      points_of_.resize(faces_.size());
      std::vector<bool> is_put(points_.size());
      for (uint32_t f = 0; f < faces_.size(); ++f)
        for (const uint32_t v : faces_[f])
          if (!is_put[v]) {
            is_put[v] = true;
            points_of_[f].push_back(v);
          }
    }
    faces_of_.resize(places_.size());
    quadrics_.resize(places_.size());
    ages_.resize(places_.size());
    for (uint32_t f = 0; f < face_count_; ++f)
      for (const uint32_t v : faces_[f]) faces_of_[v].push_back(f);
    for (uint32_t v = 0; v < places_.size(); ++v) quadrics_[v] = quadric_of(v);
    for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
      poller_.step();
      if (h < t.twin[h]) propose(corner(h), corner(Topology::next(h)));  // `none` is above all numbers
    }
  }

  /// Collapses until at most `faces` faces are left. Returns whether that was reached.
  [[nodiscard]] bool reaches(size_t faces) {
    while (face_count_ > faces && !queue_.empty()) {
      poller_.step();
      std::ranges::pop_heap(queue_, &is_costlier);
      const PairCollapse next = queue_.back();
      queue_.pop_back();
      if (!is_stale(next) && is_allowed(next)) apply(next);
    }
    return face_count_ <= faces;
  }

  [[nodiscard]] TriangleMesh result() const {
    TriangleMesh out;
    std::vector<uint32_t> index(places_.size());
    for (uint32_t v = 0; v < places_.size(); ++v) {
      if (faces_of_[v].empty()) continue;
      index[v] = static_cast<uint32_t>(out.positions.size());
      out.positions.push_back(to_float(places_[v]));
    }
    for (uint32_t f = 0; f < faces_.size(); ++f)
      if (is_alive(f)) out.triangles.push_back({index[faces_[f][0]], index[faces_[f][1]], index[faces_[f][2]]});
    return out;
  }

 private:
  /// Returns the origin of a half-edge, before any collapse.
  [[nodiscard]] uint32_t corner(uint32_t h) const { return faces_[h / 3][h % 3]; }

  /// Returns the quadric of the vertex's present faces and boundaries.
  [[nodiscard]] Quadric quadric_of(uint32_t v) const {
    Quadric sum;
    for (const uint32_t f : faces_of_[v]) {
      const auto [a, b, c] = faces_[f];
      const Vec3d twice_area = cross(places_[b] - places_[a], places_[c] - places_[a]);
      const double size = length(twice_area);
      if (size == 0) continue;
      const Vec3d normal = (1 / size) * twice_area;
      sum = sum + Quadric(normal, places_[a], size / 2);
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
        if ((from == v || to == v) && is_boundary(from, to)) sum = sum + wall(from, to, normal);
    }
    return sum;
  }

  [[nodiscard]] Quadric wall(uint32_t from, uint32_t to, Vec3d normal) const {
    const Vec3d edge = places_[to] - places_[from];
    const double squared = dot(edge, edge);
    if (squared == 0) return {};
    return {(1 / std::sqrt(squared)) * cross(edge, normal), places_[from], boundary_weight * squared};
  }

  [[nodiscard]] bool is_boundary(uint32_t a, uint32_t b) const { return count_faces(a, b) == 1; }
  [[nodiscard]] size_t count_faces(uint32_t a, uint32_t b) const {
    if (faces_of_[b].size() < faces_of_[a].size()) std::swap(a, b);
    return static_cast<size_t>(std::ranges::count_if(faces_of_[a], [&](uint32_t f) { return has(f, b); }));
  }

  void propose(uint32_t a, uint32_t b) {
    const Quadric sum = quadrics_[a] + quadrics_[b];
    const auto [kept, removed] = std::minmax(a, b);
    const Vec3d place = best_place(sum, places_[kept], places_[removed]);
    if (queue_.size() >= most_waiting_) drop_stale();
    queue_.push_back({sum.at(place), place, kept, removed, ages_[a] + ages_[b]});
    std::ranges::push_heap(queue_, &is_costlier);
  }

  [[nodiscard]] bool is_stale(const PairCollapse& c) const { return c.age != ages_[c.kept] + ages_[c.removed]; }

  /// Drops stale collapses: on flat surfaces vertices have many neighbours, and each collapse proposes all of them.
  void drop_stale() {
    std::erase_if(queue_, [&](const PairCollapse& c) { return is_stale(c); });
    std::ranges::make_heap(queue_, &is_costlier);
    most_waiting_ = std::max(least_to_drop, 2 * queue_.size());
  }

  /// Returns the quadric's minimum; if it has none, or a distant one, the best of both ends and the midpoint.
  static Vec3d best_place(const Quadric& quadric, Vec3d a, Vec3d b) {
    const Vec3d middle = 0.5 * (a + b);
    const std::optional<Vec3d> minimum = quadric.minimum();
    if (minimum && length(*minimum - middle) < 2 * length(b - a)) return *minimum;
    Vec3d best = middle;
    for (const Vec3d p : {a, b})
      if (quadric.at(p) < quadric.at(best)) best = p;
    return best;
  }

  [[nodiscard]] std::vector<uint32_t> neighbours(uint32_t v) const {
    std::vector<uint32_t> all;
    for (const uint32_t f : faces_of_[v])
      for (const uint32_t corner : faces_[f])
        if (corner != v) all.push_back(corner);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  [[nodiscard]] bool is_alive(uint32_t face) const { return faces_[face][0] != faces_[face][1]; }
  [[nodiscard]] bool has(uint32_t face, uint32_t v) const {
    return std::ranges::find(faces_[face], v) != faces_[face].end();
  }
  [[nodiscard]] bool is_allowed(const PairCollapse& c) {
    return keeps_topology(c.kept, c.removed) && turns_no_face(c) && keeps_points(c);
  }

  /// Returns whether the link condition holds: the only common neighbours of both ends are the apexes of the edge's
  /// faces; an edge between two boundary vertices is a boundary; and faces remain.
  [[nodiscard]] bool keeps_topology(uint32_t a, uint32_t b) const {
    const std::vector<uint32_t> around_a = neighbours(a), around_b = neighbours(b);
    std::vector<uint32_t> common;
    std::ranges::set_intersection(around_a, around_b, std::back_inserter(common));
    const size_t shared = count_faces(a, b);
    const bool both_on_boundary = around_a.size() > faces_of_[a].size() && around_b.size() > faces_of_[b].size();
    return common.size() == shared && !(shared == 2 && both_on_boundary) &&
           around_a.size() + around_b.size() > 2 * (shared + 1);
  }

  [[nodiscard]] Vec3d normal(const Triangle& t, uint32_t moved, Vec3d place) const {
    const auto at = [&](uint32_t v) { return v == moved ? place : places_[v]; };
    return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
  }

  [[nodiscard]] bool turns_no_face(const PairCollapse& c) const {
    const auto is_kept_upright = [&](uint32_t v, uint32_t other) {
      return std::ranges::all_of(faces_of_[v], [&](uint32_t f) {
        if (has(f, other)) return true;
        const Vec3d before = normal(faces_[f], v, places_[v]), after = normal(faces_[f], v, c.place);
        return dot(before, after) > least_cosine_of_turn * length(before) * length(after) || length(before) == 0;
      });
    };
    return is_kept_upright(c.kept, c.removed) && is_kept_upright(c.removed, c.kept);
  }

  /// Finds the nearest faces, after a collapse, of the points at the faces that it changes. Returns whether all are
  /// within the largest distance.
  [[nodiscard]] bool keeps_points(const PairCollapse& c) {
    moved_points_.clear();
    if (points_.empty()) return true;
    changed_.clear();
    for (const uint32_t v : {c.kept, c.removed})
      for (const uint32_t f : faces_of_[v])
        if (v == c.kept || !has(f, c.kept)) changed_.push_back(f);
    const auto corner_at = [&](uint32_t v) { return v == c.kept || v == c.removed ? c.place : places_[v]; };
    const auto is_kept = [&](uint32_t f) { return !(has(f, c.kept) && has(f, c.removed)); };
    for (const uint32_t f : changed_)
      for (const uint32_t point : points_of_[f]) {
        poller_.step();
        double nearest = std::numeric_limits<double>::infinity();
        uint32_t on = none;
        const auto look_at = [&](uint32_t to) {
          if (!is_kept(to)) return;
          const Triangle& t = faces_[to];
          const double squared = squared_distance(points_[point], {corner_at(t[0]), corner_at(t[1]), corner_at(t[2])});
          if (squared < nearest) nearest = squared, on = to;
        };
        if (changed_.size() > many_faces) look_at(f);
        if (!(nearest <= squared_largest_)) std::ranges::for_each(changed_, look_at);
        if (!(nearest <= squared_largest_)) return false;
        moved_points_.emplace_back(point, on);
      }
    return true;
  }

  /// Moves the points to the faces that keeps_points() has found.
  void move_points() {
    if (points_.empty()) return;
    for (const uint32_t f : changed_) points_of_[f].clear();
    for (const auto& [point, face] : moved_points_) points_of_[face].push_back(point);
  }

  void apply(const PairCollapse& c) {
    move_points();
    for (const uint32_t f : faces_of_[c.removed]) {
      if (has(f, c.kept)) {
        for (const uint32_t v : faces_[f])
          if (v != c.removed) std::erase(faces_of_[v], f);
        faces_[f] = {};
        --face_count_;
      } else {
        std::ranges::replace(faces_[f], c.removed, c.kept);
        faces_of_[c.kept].push_back(f);
      }
    }
    faces_of_[c.removed].clear();
    places_[c.kept] = c.place;
    ++ages_[c.removed];
    if (quadrics_are_ == Quadrics::memoryless) return renew_around(c.kept);
    ++ages_[c.kept];
    quadrics_[c.kept] = quadrics_[c.kept] + quadrics_[c.removed];
    for (const uint32_t v : neighbours(c.kept)) propose(c.kept, v);
  }

  /// Recomputes the quadrics of a vertex and its neighbours, and proposes all their edges.
  void renew_around(uint32_t centre) {
    std::vector<uint32_t> changed = neighbours(centre);
    changed.push_back(centre);
    for (const uint32_t v : changed) {
      quadrics_[v] = quadric_of(v);
      ++ages_[v];
    }
    std::vector<std::pair<uint32_t, uint32_t>> edges;
    for (const uint32_t v : changed)
      for (const uint32_t other : neighbours(v)) edges.emplace_back(std::min(v, other), std::max(v, other));
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const auto& [a, b] : edges) propose(a, b);
  }

  const Poller& poller_;
  Quadrics quadrics_are_;
  double squared_largest_;
  std::vector<Vec3d> points_;                     ///< vertices of the original; none without a largest distance
  std::vector<std::vector<uint32_t>> points_of_;  ///< [F] points for which the face is the nearest around
  std::vector<uint32_t> changed_;                 ///< faces of the collapse that was looked at last
  std::vector<std::pair<uint32_t, uint32_t>> moved_points_;  ///< its points, and their faces after it
  std::vector<Triangle> faces_;                              ///< faces; the corners of a removed one are equal
  std::vector<Vec3d> places_;
  std::vector<std::vector<uint32_t>> faces_of_;
  std::vector<Quadric> quadrics_;
  std::vector<uint32_t> ages_;  ///< number of changes of the vertex
  size_t face_count_;
  std::vector<PairCollapse> queue_;  ///< heap
  size_t most_waiting_ = least_to_drop;
};

}  // namespace

std::vector<TriangleMesh> collapse_to_sizes(const TriangleMesh& mesh, std::span<const size_t> faces, Quadrics quadrics,
                                            const Poller& poller, double largest) {
  Simplifier simplifier(build_mesh(mesh), quadrics, largest, poller);
  std::vector<TriangleMesh> results;
  for (const size_t count : faces) {
    if (!simplifier.reaches(count)) break;
    results.push_back(simplifier.result());
  }
  return results;
}

}  // namespace papilio
