#include "detail/collapse_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "detail/quadric.h"
#include "detail/unfolding.h"

namespace papilio {
namespace {

/// A face's normal may not turn to a smaller cosine in one collapse.
constexpr double least_cosine = 0.2;
/// Cost of thin faces beside that of the quadrics. Of 0 to 3e-3 it makes the smallest files on four models, to 7 %.
constexpr double thinness_cost = 3e-4;
constexpr size_t most_valence = 20;
constexpr uint32_t collapses_between_polls = 4096;
constexpr double refused = std::numeric_limits<double>::infinity();

struct Candidate {
  double cost;
  uint32_t vertex;  ///< to be removed
  uint32_t age;     ///< of the vertex when the cost was computed; stale once it has another one
};
/// For a heap whose top is the cheapest; ties go by number.
bool is_later(const Candidate& a, const Candidate& b) {
  return a.cost != b.cost ? a.cost > b.cost : a.vertex > b.vertex;
}

}  // namespace

class CollapseSequence::Collapser {
 public:
  Collapser(const Mesh& original, std::vector<float> weight)
      : weight_(std::move(weight)),
        out_(original.positions.size(), none),
        quadric_(original.positions.size()),
        age_(original.positions.size()),
        is_alive_(original.topology.face_count(), true),
        faces_(original.topology.face_count()) {
    const Topology& t = original.topology;
    for (const Vec3f p : original.positions) place_.push_back(to_double(p));
    origin_.assign(t.origin.begin(), t.origin.end());
    twin_.assign(t.twin.begin(), t.twin.end());
    for (uint32_t h = 0; h < origin_.size(); ++h) out_[origin_[h]] = h;
    for (uint32_t f = 0; f < faces_; ++f) add_quadrics(f);
    for (uint32_t v = 0; v < place_.size(); ++v) propose(v);
  }

  void collapse_to(uint32_t faces, const std::function<void()>& poll) {
    for (uint32_t done = 0; faces_ > faces && !queue_.empty();) {
      const Candidate next = queue_.top();
      queue_.pop();
      if (out_[next.vertex] == none || age_[next.vertex] != next.age) continue;
      collapse(next.vertex);
      if (poll && ++done % collapses_between_polls == 0) poll();
    }
  }

  [[nodiscard]] BaseMesh base() const {
    BaseMesh made;
    made.collapses = unfoldings_.size();
    std::vector<uint32_t> number(place_.size(), none);
    for (uint32_t f = 0; f < is_alive_.size(); ++f) {
      if (!is_alive_[f]) continue;
      Triangle triangle;
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t v = origin_[3 * f + i];
        if (number[v] == none) {
          number[v] = static_cast<uint32_t>(made.vertex.size());
          made.vertex.push_back(v);
          made.triangles.positions.push_back(to_float(place_[v]));
        }
        triangle[i] = number[v];
      }
      made.triangles.triangles.push_back(triangle);
      made.face.push_back(f);
    }
    return made;
  }

  void lift(std::vector<SurfacePlace>& places, size_t collapses, const std::function<void()>& poll) const {
    unfoldings_.lift(places, collapses, static_cast<uint32_t>(is_alive_.size()), poll);
  }

 private:
  [[nodiscard]] uint32_t tip(uint32_t h) const { return origin_[Topology::next(h)]; }
  [[nodiscard]] double weight(uint32_t v) const { return weight_.empty() ? 1.0 : weight_[v]; }

  void add_quadrics(uint32_t f) {
    const uint32_t* v = &origin_[size_t{3} * f];
    const Vec3d normal = cross(place_[v[1]] - place_[v[0]], place_[v[2]] - place_[v[0]]);
    const double size = length(normal);
    if (size == 0) return;
    for (uint32_t i = 0; i < 3; ++i)
      quadric_[v[i]] += Quadric((1 / size) * normal, place_[v[i]], size / 6 * weight(v[i]));
  }

  /// The half-edge that leaves the same vertex in the next face, counter-clockwise.
  [[nodiscard]] uint32_t turn(uint32_t h) const { return twin_[Topology::previous(h)]; }

  /// Collects the half-edges that leave the vertex, counter-clockwise, and their tips.
  void collect(uint32_t v) {
    spokes_.clear();
    ring_.clear();
    uint32_t h = out_[v];
    do {
      spokes_.push_back(h);
      ring_.push_back(tip(h));
      h = turn(h);
    } while (h != out_[v]);
  }
  [[nodiscard]] uint32_t ring(size_t i) const { return ring_[i % ring_.size()]; }

  /// Cost of moving the vertex, whose ring is collected, onto ring(target); `refused` from `bound` on and where that
  /// turns a face over.
  [[nodiscard]] double cost(uint32_t v, size_t target, double bound) const {
    const Vec3d to = place_[ring(target)];
    const double thinness = thinness_cost * weight(v);
    double sum = quadric_[v].at(to);
    for (size_t k = 1; k + 1 < ring_.size() && sum < bound; ++k) {
      const Vec3d b = place_[ring(target + k)];
      const Vec3d c = place_[ring(target + k + 1)];
      const Vec3d after = cross(b - to, c - to);
      const Vec3d before = cross(b - place_[v], c - place_[v]);
      const double size = length(after);
      if (!(dot(after, before) > least_cosine * size * length(before))) return refused;
      const double edges = dot(b - to, b - to) + dot(c - to, c - to) + dot(c - b, c - b);
      const double slenderness = edges / (2 * std::numbers::sqrt3 * size);  // 1: all sides are equal
      sum += thinness * (slenderness - 1) * edges * edges;
    }
    return sum < bound ? sum : refused;
  }

  void propose(uint32_t v) {
    collect(v);
    double least = refused;
    for (size_t i = 0; i < ring_.size(); ++i) least = std::min(least, cost(v, i, least));
    if (least < refused) queue_.push({least, v, age_[v]});
  }

  /// Removes the vertex by the cheapest collapse that is possible.
  void collapse(uint32_t v) {
    collect(v);
    std::vector<std::pair<double, size_t>> targets;
    for (size_t i = 0; i < ring_.size(); ++i)
      if (const double c = cost(v, i, refused); c < refused) targets.emplace_back(c, i);
    std::ranges::sort(targets);
    for (const auto& [c, target] : targets) {
      if (!keeps_topology(target) || !unfold(v, target)) continue;
      unfoldings_.push(unfolding_);
      apply(v, target);
      return;
    }
  }

  [[nodiscard]] size_t valence(uint32_t v) const {
    size_t count = 0;
    uint32_t h = out_[v];
    do {
      ++count;
      h = turn(h);
    } while (h != out_[v]);
    return count;
  }

  /// Whether the two vertices share no neighbours but the two apexes, and these keep three faces.
  [[nodiscard]] bool keeps_topology(size_t target) const {
    const uint32_t to = ring(target);
    if (ring_.size() < 3 || valence(to) + ring_.size() - 4 > most_valence) return false;
    if (valence(ring(target + 1)) <= 3 || valence(ring(target + ring_.size() - 1)) <= 3) return false;
    uint32_t h = out_[to];
    do {
      for (size_t k = 2; k + 1 < ring_.size(); ++k)
        if (tip(h) == ring(target + k)) return false;
      h = turn(h);
    } while (h != out_[to]);
    return true;
  }

  [[nodiscard]] bool unfold(uint32_t v, size_t target) {
    unfolding_.clear();
    for (size_t k = 0; k < ring_.size(); ++k) {
      const Vec3d a = place_[ring(target + k)] - place_[v];
      const Vec3d b = place_[ring(target + k + 1)] - place_[v];
      unfolding_.add(spokes_[(target + k) % ring_.size()], length(a), std::atan2(length(cross(a, b)), dot(a, b)));
    }
    unfolding_.lay_out();
    return unfolding_.is_valid();
  }

  void join(uint32_t a, uint32_t b) {
    twin_[a] = b;
    twin_[b] = a;
  }

  /// Moves the vertex onto ring(target); the two faces at the edge between them go.
  void apply(uint32_t v, size_t target) {
    const size_t before = (target + ring_.size() - 1) % ring_.size();
    const uint32_t to = ring_[target];
    const uint32_t left = ring(target + 1);
    const uint32_t right = ring_[before];
    const uint32_t first = spokes_[target];  // v to `to`, the left apex opposite
    const uint32_t last = spokes_[before];   // v to the right apex, `to` opposite
    for (const uint32_t h : spokes_) origin_[h] = to;
    const uint32_t left_to = twin_[Topology::next(first)];
    const uint32_t to_left = twin_[Topology::previous(first)];
    const uint32_t to_right = twin_[Topology::next(last)];
    const uint32_t right_to = twin_[last];
    join(left_to, to_left);
    join(to_right, right_to);
    is_alive_[first / 3] = is_alive_[last / 3] = false;
    faces_ -= 2;
    out_[v] = none;
    out_[to] = to_left;
    out_[left] = left_to;
    out_[right] = right_to;
    quadric_[to] += quadric_[v];
    const std::vector<uint32_t> changed = ring_;
    for (const uint32_t w : changed) {
      ++age_[w];
      propose(w);
    }
  }

  std::vector<float> weight_;
  std::vector<Vec3d> place_;      // [V]
  std::vector<uint32_t> origin_;  // [H]
  std::vector<uint32_t> twin_;    // [H]
  std::vector<uint32_t> out_;     // [V] a half-edge that leaves the vertex; none once it is removed
  std::vector<Quadric> quadric_;  // [V]
  std::vector<uint32_t> age_;     // [V] changes round it
  std::vector<bool> is_alive_;    // [F]
  uint32_t faces_;
  std::priority_queue<Candidate, std::vector<Candidate>, decltype(&is_later)> queue_{&is_later};
  UnfoldingSequence unfoldings_;
  Unfolding unfolding_;                  // of the collapse at hand
  std::vector<uint32_t> spokes_, ring_;  // of the vertex at hand
};

CollapseSequence::CollapseSequence(const Mesh& original, std::vector<float> weight)
    : collapser_(std::make_unique<Collapser>(original, std::move(weight))) {}
CollapseSequence::~CollapseSequence() = default;

void CollapseSequence::collapse_to(uint32_t faces, const std::function<void()>& poll) {
  collapser_->collapse_to(faces, poll);
}

BaseMesh CollapseSequence::base() const { return collapser_->base(); }

void CollapseSequence::lift(std::vector<SurfacePlace>& places, const BaseMesh& base,
                            const std::function<void()>& poll) const {
  collapser_->lift(places, base.collapses, poll);
}

}  // namespace papilio
