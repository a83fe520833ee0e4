#include "mesh/divide_faces.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "base/sort.h"

namespace papilio {
namespace {

constexpr double least_share = 1e-9;  // lower bound of a part's area, a share of its face's

struct Corner {
  VertexId vertex = none, point = none;
};
using Piece = std::array<Corner, 3>;
using Side = std::vector<Corner>;

/// Divides a triangle into parts, given the corners on each side, ends included.
std::vector<Piece> cut(const std::array<Side, 3>& sides) {
  const auto& [first, second, third] = sides;
  std::vector<Piece> parts;
  for (size_t i = 1; i < first.size(); ++i) parts.push_back({first[i - 1], first[i], third[0]});
  if (second.size() > 2) {  // the last part has the second side
    const Corner from = parts.back()[0];
    parts.pop_back();
    for (size_t i = 1; i < second.size(); ++i) parts.push_back({from, second[i - 1], second[i]});
  }
  if (third.size() > 2) {
    const auto part = first.size() > 2 ? parts.begin() : parts.end() - 1;  // that has the third side
    const Corner from = (*part)[1];
    parts.erase(part);
    for (size_t i = 1; i < third.size(); ++i) parts.push_back({from, third[i - 1], third[i]});
  }
  return parts;
}

class FaceDivider {
 public:
  FaceDivider(const Draft& draft, std::span<const Insertion> insertions, BlendedPoints& points)
      : draft_(draft), insertions_(insertions), points_(points), known_(draft.topology.vertex_count) {
    for (const Insertion& insertion : insertions) known_[insertion.vertex].is_inserted = true;
    const Topology& mesh = draft.topology;
    for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h) {
      Known& known = known_[mesh.origin[h]];
      if (known.is_inserted && known.half_edge == none && mesh.twin[h] == none) known.half_edge = h;
      if (known.is_inserted || known_[mesh.tip(h)].is_inserted) runs_.push_back(direction(mesh.origin[h], mesh.tip(h)));
    }
    sort_range(runs_);
  }

  Draft run() {
    Draft divided;
    divided.positions = draft_.positions;
    divided.report = draft_.report;
    out_ = &divided;
    const Topology& mesh = draft_.topology;
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      const uint32_t inserted = divide(f);
      divided.report.t_junctions += inserted;
      if (inserted == 0) add({corner(3 * f), corner(3 * f + 1), corner(3 * f + 2)});
    }
    for (const Insertion& insertion : insertions_) divided.tracked.push_back(insertion.vertex);
    settle(divided);
    return divided;
  }

 private:
  struct Known {
    uint32_t half_edge = none;  ///< boundary half-edge that leaves the vertex
    bool is_inserted = false;
  };

  static uint64_t direction(uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; }
  [[nodiscard]] Vec3d at(VertexId vertex) const { return to_double(draft_.positions[vertex]); }
  [[nodiscard]] bool has_points() const { return !draft_.corner_point.empty(); }
  [[nodiscard]] Corner corner(HalfEdgeId h) const {
    return {draft_.topology.origin[h], has_points() ? draft_.corner_point[h] : none};
  }
  [[nodiscard]] Vec3d normal(uint32_t a, uint32_t b, uint32_t c) const { return cross(at(b) - at(a), at(c) - at(a)); }

  void add(const Piece& part) {
    for (const auto& [vertex, point] : part) {
      out_->topology.origin.push_back(vertex);
      if (has_points()) out_->corner_point.push_back(point);
    }
  }

  /// Returns the corners along a half-edge, and consumes its insertions.
  Side side(HalfEdgeId h) {
    const Corner from = corner(h), to = corner(h.next());
    Side side{from};
    for (; next_ < insertions_.size() && insertions_[next_].half_edge == h; ++next_) {
      const auto& [half_edge, share, vertex] = insertions_[next_];
      side.push_back({vertex, has_points() ? point_at(vertex, from.point, to.point, share) : none});
    }
    side.push_back(to);
    return side;
  }

  uint32_t point_at(VertexId vertex, uint32_t from, uint32_t to, double share) {
    const HalfEdgeId h = known_[vertex].half_edge;
    const std::array<uint32_t, 1> known{h == none ? none : draft_.corner_point[h]};
    return points_.between(from, to, share, h == none ? std::span<const uint32_t>{} : known);
  }

  /// Adds the parts of a face in its place. Returns how many vertices were inserted; 0 if the face stays whole.
  uint32_t divide(FaceId f) {
    if (next_ == insertions_.size() || Topology::face(insertions_[next_].half_edge) != f) return 0;
    const size_t first = next_;
    std::array<Side, 3> sides;
    for (uint32_t i = 0; i < 3; ++i) sides[i] = side(3 * f + i);
    const std::vector<Piece> parts = cut(sides);
    if (!have_area(f, parts) || !claim_runs(parts)) return 0;
    for (const Piece& part : parts) add(part);
    return static_cast<uint32_t>(next_ - first);
  }

  [[nodiscard]] bool have_area(FaceId f, const std::vector<Piece>& parts) const {
    const uint32_t* v = &draft_.topology.origin[3 * f];
    const Vec3d whole = normal(v[0], v[1], v[2]);
    return std::ranges::all_of(parts, [&](const Piece& part) {
      return dot(normal(part[0].vertex, part[1].vertex, part[2].vertex), whole) > least_share * dot(whole, whole);
    });
  }

  /// Claims the directions between vertices that the parts' half-edges run in. Returns false, and claims none, if one
  /// of them is taken.
  bool claim_runs(const std::vector<Piece>& parts) {
    std::vector<uint64_t> runs;
    for (const Piece& part : parts)
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t from = part[i].vertex, to = part[(i + 1) % 3].vertex;
        if (known_[from].is_inserted || known_[to].is_inserted) runs.push_back(direction(from, to));
      }
    const Topology& mesh = draft_.topology;
    const uint32_t first = 3 * Topology::face(insertions_[next_ - 1].half_edge);
    const auto is_free = [&](uint64_t run) {
      for (HalfEdgeId h = first; h < first + 3; ++h)
        if (run == direction(mesh.origin[h], mesh.tip(h))) return true;  // a side of the face itself
      return !std::ranges::binary_search(runs_, run) && !claimed_.contains(run);
    };
    if (!std::ranges::all_of(runs, is_free)) return false;
    claimed_.insert(runs.begin(), runs.end());
    return true;
  }

  const Draft& draft_;
  std::span<const Insertion> insertions_;
  BlendedPoints& points_;
  std::vector<Known> known_;    ///< [V]
  std::vector<uint64_t> runs_;  ///< directions at inserted vertices in which half-edges run, in ascending order
  std::set<uint64_t> claimed_;  ///< directions in which half-edges of parts run
  size_t next_ = 0;             ///< first insertion not yet consumed
  Draft* out_ = nullptr;
};

}  // namespace

Draft divide_faces(const Draft& draft, std::span<const Insertion> insertions, BlendedPoints& points) {
  return FaceDivider(draft, insertions, points).run();
}

}  // namespace papilio
