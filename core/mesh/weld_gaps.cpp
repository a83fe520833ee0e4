#include "mesh/weld_gaps.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/sort.h"
#include "mesh/point_tree.h"
#include "mesh/vertex_spokes.h"

namespace papilio {
namespace {

constexpr size_t most_partners = 16;   // upper bound of the candidates for an edge
constexpr size_t most_together = 256;  // upper bound of the vertices welded to one
constexpr uint64_t looks_a_face = 32;  // upper bound of the average number of checks of a face
constexpr uint64_t least_looks = 1 << 18;

class GapWelder {
 public:
  GapWelder(const Topology& mesh, const Buffer<Vec3f>& positions, double distance)
      : mesh_(mesh),
        positions_(positions),
        distance_(distance),
        most_looks_(looks_a_face * mesh.face_count() + least_looks) {
    for (const HalfEdgeId h : mesh.half_edge)
      if (mesh.kind[mesh.edge[h]] == EdgeKind::boundary) open_.push_back(h);
  }

  Buffer<uint32_t> run() {
    std::vector<Vec3d> middles;
    for (const HalfEdgeId h : open_) middles.push_back(0.5 * (at(mesh_.origin[h]) + at(mesh_.tip(h))));
    PointTree tree(middles);
    is_closed_.assign(open_.size(), false);
    for (uint32_t i = 0; i < open_.size() && !tree.is_exhausted() && looks_ < most_looks_; ++i)
      if (!is_closed_[i]) close(i, middles[i], tree);
    return is_changed_ ? std::move(root_) : Buffer<uint32_t>{};
  }

 private:
  struct Candidate {
    double distance;  ///< sum of the squared distances between the ends
    uint32_t number;  ///< index in `open_`
  };

  [[nodiscard]] Vec3d at(VertexId vertex) const { return to_double(positions_[vertex]); }
  [[nodiscard]] double squared_distance(VertexId v, uint32_t w) const {
    const Vec3d apart = at(v) - at(w);
    return dot(apart, apart);
  }

  /// Closes an open edge with the nearest one that join_ends() accepts.
  void close(uint32_t i, Vec3d middle, PointTree& tree) {
    std::vector<Candidate> candidates;
    tree.for_each_near(middle, middle, distance_, [&](uint32_t j) {
      if (const auto apart = gap(i, j)) candidates.push_back({*apart, j});
      return candidates.size() < most_partners;
    });
    sort_range(candidates, [](const Candidate& a, const Candidate& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
    });
    for (const Candidate& candidate : candidates) {
      if (!join_ends(open_[i], open_[candidate.number])) continue;
      is_closed_[i] = is_closed_[candidate.number] = true;
      return;
    }
  }

  /// Returns the sum of the squared distances between the ends of two open edges; nothing if they cannot close.
  [[nodiscard]] std::optional<double> gap(uint32_t i, uint32_t j) const {
    const HalfEdgeId h = open_[i], g = open_[j];
    if (is_closed_[j] || h.face() == Topology::face(g)) return std::nullopt;
    const double first = squared_distance(mesh_.origin[h], mesh_.tip(g));
    const double second = squared_distance(mesh_.tip(h), mesh_.origin[g]);
    if (std::max(first, second) > distance_ * distance_) return std::nullopt;
    return first + second;
  }

  void prepare() {
    if (spokes_) return;
    spokes_.emplace(mesh_);
    root_.resize_for_overwrite(mesh_.vertex_count);
    std::iota(root_.begin(), root_.end(), 0U);
    next_ = root_;
    size_.assign(mesh_.vertex_count, 1);
  }

  /// Welds the ends of two edges if that makes no defect. Returns whether it did.
  bool join_ends(HalfEdgeId h, uint32_t g) {
    prepare();
    const Merge merge(root_[mesh_.origin[h]], root_[mesh_.tip(g)], root_[mesh_.tip(h)], root_[mesh_.origin[g]]);
    if (!may_move(merge) || !keeps_faces(merge)) return false;
    for (const auto& [from, to] : merge.moves()) join(from, to);
    is_changed_ = true;
    return true;
  }

  /// Roots to be replaced, each by a lower one.
  struct Merge {
    Merge() = default;
    Merge(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
      add(a, b);
      // The first move may have changed the second pair.
      add((*this)(c), (*this)(d));
    }
    void add(uint32_t a, uint32_t b) {
      if (a != b) all[count++] = {std::max(a, b), std::min(a, b)};
    }
    [[nodiscard]] uint32_t operator()(uint32_t root) const {
      for (const auto& [from, to] : moves())
        if (root == from) root = to;
      return root;
    }
    struct Move {
      uint32_t from, to;
    };
    [[nodiscard]] std::span<const Move> moves() const { return {all.data(), count}; }
    std::array<Move, 2> all{};
    size_t count = 0;
  };

  template <class Visit>
  void for_each_member(uint32_t root, Visit visit) const {
    uint32_t member = root;
    do {
      visit(member);
      member = next_[member];
    } while (member != root);
  }

  [[nodiscard]] bool may_move(const Merge& merge) const {
    bool may = true;
    for (const Merge::Move& move : merge.moves()) {
      may = may && size_[move.from] + size_[move.to] <= most_together;
      const uint32_t root = merge(move.to);
      if (may)
        for_each_member(move.from, [&](VertexId v) { may &= squared_distance(v, root) <= distance_ * distance_; });
    }
    return may;
  }

  /// Returns whether all faces at the merged vertices keep three corners and their orientation, and the number of
  /// repeated half-edges does not grow.
  bool keeps_faces(const Merge& merge) {
    faces_.clear();
    for (const auto& [from, to] : merge.moves())
      for (const uint32_t root : {from, to})
        for_each_member(root, [&](VertexId v) {
          for (const HalfEdgeId h : spokes_->of(v)) faces_.push_back(h.face());
        });
    sort_range(faces_);
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    looks_ += faces_.size();
    for (const FaceId f : faces_)
      if (!keeps_side(f, merge)) return false;
    const size_t repeated = count_repeated(merge);
    return repeated == 0 || repeated <= count_repeated({});
  }

  [[nodiscard]] bool keeps_side(FaceId face, const Merge& merge) const {
    Triangle before{}, after{};
    for (uint32_t i = 0; i < 3; ++i) {
      before[i] = root_[mesh_.origin[3 * face + i]];
      after[i] = merge(before[i]);
    }
    if (after[0] == after[1] || after[1] == after[2] || after[2] == after[0]) return false;
    const auto normal = [&](const Triangle& t) { return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])); };
    const Vec3d old = normal(before);
    return dot(old, old) == 0 || dot(old, normal(after)) > 0;
  }

  /// Returns the number of half-edges of `faces_` that run between two vertices in one direction with an earlier one.
  [[nodiscard]] size_t count_repeated(const Merge& merge) {
    runs_.clear();
    for (const FaceId f : faces_)
      for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h)
        runs_.emplace_back(merge(root_[mesh_.origin[h]]), merge(root_[mesh_.tip(h)]));
    sort_range(runs_);
    size_t repeated = 0;
    for (size_t i = 1; i < runs_.size(); ++i) repeated += runs_[i] == runs_[i - 1] ? 1 : 0;
    return repeated;
  }

  void join(uint32_t from, uint32_t to) {
    for_each_member(from, [&](VertexId v) { root_[v] = to; });
    std::swap(next_[from], next_[to]);
    size_[to] += size_[from];
  }

  const Topology& mesh_;
  const Buffer<Vec3f>& positions_;
  const double distance_;
  std::vector<uint32_t> open_;  ///< half-edges at the boundary
  std::vector<bool> is_closed_;
  std::optional<VertexSpokes> spokes_;
  Buffer<uint32_t> root_;                            ///< [V] lowest vertex welded with the vertex
  Buffer<uint32_t> next_;                            ///< [V] next vertex welded with the vertex, in a cycle
  std::vector<uint32_t> faces_;                      ///< faces at the vertices of the merge
  std::vector<std::pair<uint32_t, uint32_t>> runs_;  ///< origin and tip of half-edges of `faces_`
  Buffer<uint32_t> size_;                            ///< [V] number of vertices welded with a root
  bool is_changed_ = false;
  uint64_t looks_ = 0, most_looks_;
};

}  // namespace

Buffer<uint32_t> weld_gaps(const Topology& mesh, const Buffer<Vec3f>& positions, double distance) {
  return GapWelder(mesh, positions, distance).run();
}

}  // namespace papilio
