#include "detail/slivers.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace papilio {
namespace {

/// Lower bound of the thickness of a face that is no sliver: twice its area over its longest side's square. An
/// equilateral face has 0.87.
constexpr double sliver_thickness = 0.05;
/// Lower bound of the cosine between the normals before and after, of a face that is no sliver.
constexpr double least_cosine_of_wide_face = 0.5;
/// Upper bound of a move, a share of the mean edge, so that a regular mesh stays unchanged.
constexpr double most_of_edge = 0.1;

struct Face {
  Vec3d a, b, c;

  [[nodiscard]] Vec3d normal() const { return cross(b - a, c - a); }
  [[nodiscard]] double longest() const { return std::max({length(b - a), length(c - b), length(a - c)}); }
  [[nodiscard]] double thickness() const {
    const double side = longest();
    return side > 0 ? length(normal()) / (side * side) : 0;
  }
};

double cosine(Vec3d a, Vec3d b) {
  const double sizes = length(a) * length(b);
  return sizes > 0 ? dot(a, b) / sizes : 0;
}

double mean_edge_length(const Mesh& mesh) {
  double sum = 0;
  const Topology& t = mesh.topology;
  for (uint32_t h = 0; h < t.half_edge_count(); ++h)
    sum += length(to_double(mesh.positions[t.tip(h)]) - to_double(mesh.positions[t.origin[h]]));
  return sum / t.half_edge_count();
}

class SliverRemover {
 public:
  SliverRemover(Mesh& mesh, double distance, const Poller& poller)
      : positions_(mesh.positions),
        distance_(distance),
        poller_(poller),
        origin_(mesh.topology.origin),
        twin_(mesh.topology.twin),
        point_(mesh.attributes.empty() ? mesh.topology.origin : mesh.attributes.point),
        is_alive_(mesh.topology.face_count(), true),
        moved_(mesh.topology.vertex_count, 0.0F) {}

  /// Returns whether a face changed.
  bool run() {
    for (auto f = static_cast<uint32_t>(is_alive_.size()); f-- > 0;) {
      poller_.step();
      if (is_removable(f)) waiting_.push_back(f);
    }
    bool is_changed = false;
    while (!waiting_.empty()) {
      poller_.step();
      const uint32_t f = waiting_.back();
      waiting_.pop_back();
      if (is_alive_[f] && is_removable(f) && remove(f)) is_changed = true;
    }
    return is_changed;
  }

  /// Returns the corners of the remaining faces, as points.
  [[nodiscard]] Buffer<Triangle> triangles() const {
    Buffer<Triangle> made;
    for (uint32_t f = 0; f < is_alive_.size(); ++f)
      if (is_alive_[f]) made.push_back({point_[3 * f], point_[3 * f + 1], point_[3 * f + 2]});
    return made;
  }

 private:
  /// Faces round a vertex, counter-clockwise.
  struct Ring {
    std::vector<uint32_t> spokes;      ///< half-edges that leave the vertex
    std::vector<uint32_t> neighbours;  ///< neighbours; one more than spokes at a boundary
    [[nodiscard]] bool is_closed() const { return spokes.size() == neighbours.size(); }
    /// Returns whether the vertex may lose a face: an interior vertex keeps three, a boundary vertex one.
    [[nodiscard]] bool has_spare_face() const { return neighbours.size() > (is_closed() ? 3 : 2); }
    [[nodiscard]] bool has(uint32_t v) const { return std::ranges::find(neighbours, v) != neighbours.end(); }
  };

  [[nodiscard]] static uint32_t next(uint32_t h) { return Topology::next(h); }
  [[nodiscard]] static uint32_t previous(uint32_t h) { return Topology::previous(h); }
  [[nodiscard]] uint32_t tip(uint32_t h) const { return origin_[next(h)]; }
  [[nodiscard]] uint32_t apex(uint32_t h) const { return origin_[previous(h)]; }
  [[nodiscard]] Vec3d place(uint32_t v) const { return to_double(positions_[v]); }
  [[nodiscard]] double edge_length(uint32_t h) const { return length(place(tip(h)) - place(origin_[h])); }
  [[nodiscard]] Face face(uint32_t f) const {
    return {place(origin_[3 * f]), place(origin_[3 * f + 1]), place(origin_[3 * f + 2])};
  }
  /// Returns whether a face is to be removed: it is a sliver, or all its sides are short.
  [[nodiscard]] bool is_removable(uint32_t f) const {
    const Face at = face(f);
    return at.thickness() < sliver_thickness || at.longest() <= distance_;
  }
  [[nodiscard]] bool is_seam(uint32_t h) const {
    const uint32_t t = twin_[h];
    return t != none && (point_[h] != point_[next(t)] || point_[next(h)] != point_[t]);
  }

  /// Returns the faces round the origin of a half-edge.
  [[nodiscard]] Ring ring_at(uint32_t h) const {
    uint32_t first = h;
    while (twin_[first] != none) {
      first = next(twin_[first]);
      if (first == h) break;
    }
    Ring ring;
    for (uint32_t at = first;;) {
      ring.spokes.push_back(at);
      ring.neighbours.push_back(tip(at));
      const uint32_t turned = twin_[previous(at)];
      if (turned == first) return ring;
      if (turned == none) {
        ring.neighbours.push_back(apex(at));
        return ring;
      }
      at = turned;
    }
  }
  /// Returns the area-weighted sum of the faces' normals.
  [[nodiscard]] Vec3d normal_of(const Ring& ring) const {
    Vec3d sum;
    for (const uint32_t h : ring.spokes) sum += face(h / 3).normal();
    return sum;
  }

  bool remove(uint32_t f) {
    std::array<uint32_t, 3> sides{3 * f, 3 * f + 1, 3 * f + 2};
    std::ranges::sort(sides, {}, [&](uint32_t h) { return edge_length(h); });
    for (const uint32_t h : {sides[0], sides[1]}) {
      if (edge_length(h) > distance_) break;
      if (collapse(h, h) || collapse(next(h), h)) return true;
    }
    const double longest = edge_length(sides[2]);
    const double height = longest > 0 ? length(face(f).normal()) / longest : 0;
    return twin_[sides[2]] == none ? drop(sides[2], height) : flip(sides[2], height);
  }

  /// Moves the origin of `leaving`, one end of the edge of h, onto the other end.
  bool collapse(uint32_t leaving, uint32_t h) {
    const bool is_origin = leaving == h;
    const uint32_t onto = is_origin ? tip(h) : origin_[h];
    const uint32_t removed = origin_[leaving];
    const auto moved = static_cast<float>(edge_length(h) + moved_[removed]);
    const Ring ring = ring_at(leaving);
    const Ring other = ring_at(is_origin ? next(h) : h);
    if (moved > distance_ || !keeps_topology(ring, other, h)) return false;
    if (!keeps_sides(ring, other, onto)) return false;
    const std::vector<uint32_t> points = moved_points(ring, h, onto);
    if (points.empty()) return false;

    moved_[onto] = std::max(moved_[onto], moved);
    for (size_t i = 0; i < ring.spokes.size(); ++i) {
      origin_[ring.spokes[i]] = onto;
      point_[ring.spokes[i]] = points[i];
    }
    const uint32_t twin = twin_[h];
    take_face(h);
    if (twin != none) take_face(twin);
    for (const Ring* changed : {&ring, &other})
      for (const uint32_t spoke : changed->spokes) wait(spoke / 3);
    return true;
  }

  /// Returns whether the ends of the edge of h share no neighbours but its apexes, which keep enough faces.
  [[nodiscard]] bool keeps_topology(const Ring& ring, const Ring& other, uint32_t h) const {
    const uint32_t twin = twin_[h];
    if (twin != none && !ring.is_closed()) return false;
    if (!ring_at(previous(h)).has_spare_face()) return false;
    if (twin != none && !ring_at(previous(twin)).has_spare_face()) return false;
    const auto shared = std::ranges::count_if(ring.neighbours, [&](uint32_t v) { return other.has(v); });
    return shared == (twin == none ? 1 : 2);
  }

  /// Returns whether the move of the ring's vertex turns over no remaining face.
  [[nodiscard]] bool keeps_sides(const Ring& ring, const Ring& other, uint32_t onto) const {
    const Vec3d normal = normal_of(ring) + normal_of(other);
    for (const uint32_t spoke : ring.spokes) {
      if (tip(spoke) == onto || apex(spoke) == onto) continue;
      const Face before = face(spoke / 3);
      const Face after{place(onto), place(tip(spoke)), place(apex(spoke))};
      const bool was_sliver = before.thickness() < sliver_thickness || before.longest() <= distance_;
      const bool is_sliver = after.thickness() < sliver_thickness;
      if (!was_sliver && (is_sliver || cosine(before.normal(), after.normal()) < least_cosine_of_wide_face))
        return false;
      if (was_sliver && !is_sliver && !(dot(after.normal(), normal) > 0)) return false;
    }
    return true;
  }

  /// Returns the points of the corners at the ring's vertex after its move along the edge of h; empty if seams would
  /// end.
  [[nodiscard]] std::vector<uint32_t> moved_points(const Ring& ring, uint32_t h, uint32_t onto) const {
    const auto point_at = [&](uint32_t side) { return origin_[side] == onto ? point_[side] : point_[next(side)]; };
    const auto seams = std::ranges::count_if(ring.spokes, [&](uint32_t spoke) { return is_seam(spoke); });
    std::vector<uint32_t> points(ring.spokes.size(), point_at(h));
    if (seams == 0) return points;
    if (seams != 2 || !ring.is_closed() || !is_seam(h)) return {};
    // Finds the half-edge that leaves the vertex along the edge of h.
    const auto start = std::ranges::find_if(ring.spokes, [&](uint32_t spoke) { return tip(spoke) == onto; });
    const auto first = static_cast<size_t>(start - ring.spokes.begin());
    uint32_t point = point_at(*start);
    for (size_t k = 0; k < points.size(); ++k) {
      const size_t i = (first + k) % points.size();
      if (k > 0 && is_seam(ring.spokes[i])) {
        if (k == 1 || k + 1 == points.size()) return {};  // two seams would merge
        point = point_at(twin_[*start]);
      }
      points[i] = point;
    }
    return points;
  }

  /// Removes the face of a side whose ends have merged: its other sides become one edge.
  void take_face(uint32_t side) {
    connect(twin_[next(side)], twin_[previous(side)]);
    is_alive_[side / 3] = false;
  }
  void connect(uint32_t a, uint32_t b) {
    if (a != none) twin_[a] = b;
    if (b != none) twin_[b] = a;
  }
  void wait(uint32_t f) {
    if (is_alive_[f] && is_removable(f)) waiting_.push_back(f);
  }

  /// Replaces the edge of h by the other diagonal of its two faces.
  bool flip(uint32_t h, double height) {
    const uint32_t t = twin_[h];
    const uint32_t a = origin_[h], b = tip(h), c = apex(h), d = apex(t);
    const float moved = static_cast<float>(height) + std::max({moved_[a], moved_[b], moved_[c]});
    if (moved > distance_ || c == d || is_seam(h)) return false;
    if (!ring_at(h).has_spare_face() || !ring_at(t).has_spare_face() || ring_at(previous(h)).has(d)) return false;
    const Face beyond = face(t / 3);
    const std::array<Face, 2> made{Face{place(c), place(a), place(d)}, Face{place(d), place(b), place(c)}};
    const double before = std::min(face(h / 3).thickness(), beyond.thickness());
    const bool is_beyond_thin = beyond.thickness() < sliver_thickness;
    const Vec3d normal = is_beyond_thin ? normal_of(ring_at(previous(h))) : beyond.normal();
    for (const Face& f : made) {
      const double thickness = f.thickness();
      if (!(thickness > before)) return false;
      if (thickness >= sliver_thickness &&
          !(cosine(f.normal(), normal) > (is_beyond_thin ? 0 : least_cosine_of_wide_face)))
        return false;
    }
    moved_[c] = moved;
    const std::array<uint32_t, 6> from{previous(h), next(t), previous(t), previous(t), next(h), previous(h)};
    const std::array<uint32_t, 6> to{h - h % 3, h - h % 3 + 1, h - h % 3 + 2, t - t % 3, t - t % 3 + 1, t - t % 3 + 2};
    std::array<std::array<uint32_t, 3>, 6> corners{};
    for (size_t i = 0; i < 6; ++i) corners[i] = {origin_[from[i]], point_[from[i]], twin_[from[i]]};
    for (size_t i = 0; i < 6; ++i) {
      origin_[to[i]] = corners[i][0];
      point_[to[i]] = corners[i][1];
    }
    for (const size_t i : {0U, 1U, 3U, 4U}) {
      twin_[to[i]] = none;
      connect(to[i], corners[i][2]);
    }
    connect(to[2], to[5]);
    wait(h / 3);
    wait(t / 3);
    return true;
  }

  /// Removes the face of the boundary half-edge h, so that the boundary goes through the vertex opposite h.
  bool drop(uint32_t h, double height) {
    const float moved = static_cast<float>(height) + moved_[apex(h)];
    if (moved > distance_ || !ring_at(previous(h)).is_closed()) return false;
    moved_[apex(h)] = moved;
    connect(twin_[next(h)], none);
    connect(twin_[previous(h)], none);
    is_alive_[h / 3] = false;
    return true;
  }

  const Buffer<Vec3f>& positions_;
  double distance_;
  const Poller& poller_;
  Buffer<uint32_t> origin_;        // [H]
  Buffer<uint32_t> twin_;          // [H]
  Buffer<uint32_t> point_;         // [H] points, or vertices without attributes
  std::vector<bool> is_alive_;     // [F]
  std::vector<float> moved_;       // [V] upper bound of the distance by which the surface moved onto the vertex
  std::vector<uint32_t> waiting_;  // faces that may be slivers
};

}  // namespace

Mesh remove_slivers(Mesh mesh, double distance, const Poller& poller) {
  distance = std::min(distance, most_of_edge * mean_edge_length(mesh));
  SliverRemover remover(mesh, distance, poller);
  if (!remover.run()) return mesh;
  TriangleMesh made = std::move(mesh).triangles();
  made.triangles = remover.triangles();
  return build_mesh(made);
}

}  // namespace papilio
