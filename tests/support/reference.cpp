#include "tests/support/reference.h"

#include <bit>
#include <ranges>

#include "tests/support/reference_criteria.h"
#include "tests/support/reference_rules.h"

namespace papilio::reference {
namespace {

/// Surface and the new vertices of all its edges.
struct Level {
  Level(Surface surface, const Options& options, Margin& margin) : s(std::move(surface)), at(s.at) {
    Rules rules(s, options, margin);
    for (uint32_t e = 0; e < s.edges.size(); ++e) at.push_back(rules.new_vertex(e));
  }
  Surface s;
  std::vector<Vec3d> at;  ///< its vertices, then the new vertex of each edge

  [[nodiscard]] uint32_t new_vertex(uint32_t e) const { return static_cast<uint32_t>(s.at.size()) + e; }
  [[nodiscard]] Vec3d made(uint32_t e) const { return at[new_vertex(e)]; }
  /// Returns the pieces of a face where the sides in the mask are split.
  [[nodiscard]] std::vector<Triangle> cut(uint32_t f, unsigned mask, bool second_diagonal) const {
    const auto& [i, j, k] = s.sides[f];
    return pieces(s.faces[f], {new_vertex(i), new_vertex(j), new_vertex(k)}, mask, second_diagonal);
  }
  /// Returns the cosine of the smallest angle of some faces.
  [[nodiscard]] double smallest_angle(const std::vector<Triangle>& faces) const {
    double cosine = 0;
    for (const auto& [a, b, c] : faces)
      cosine = std::max({cosine, -cosine_of_turn(at[a], at[b], at[c]), -cosine_of_turn(at[b], at[c], at[a]),
                         -cosine_of_turn(at[c], at[a], at[b])});
    return cosine;
  }
  /// Returns the surface of some pieces. Halves of creases are creases.
  [[nodiscard]] Surface below(const std::vector<Triangle>& faces) const {
    std::set<Surface::Pair> creases;
    for (uint32_t e = 0; e < s.edges.size(); ++e)
      if (const auto& [a, b, at_edge, kind] = s.edges[e]; kind == Kind::crease)
        creases.insert({{a, b}, {a, new_vertex(e)}, {b, new_vertex(e)}});
    return {at, faces, creases};
  }
};

class Refiner {
 public:
  Refiner(const Options& options, const Criteria& criteria, double diagonal, Margin& margin)
      : options_(options),
        criteria_(criteria),
        is_in_place_(options.scheme == Scheme::in_place && !criteria.is_uniform()),
        diagonal_(diagonal),
        margin_(margin) {}

  Outcome run(const Surface& coarse) {
    start(coarse);
    most_cosine_ = std::cos(0.4 * std::acos(levels_[0].smallest_angle(coarse.faces)));
    bool is_out_of_budget = false;
    for (int number = 1; number <= options_.levels; ++number) {
      weigh(number);
      is_out_of_budget |= choose();
      if (std::ranges::any_of(split_, [&](const Key& key) { return key.first == deepest(); })) {
        outcome_.levels = number;
        kept_ = split_;
      } else if (is_in_place_ && criteria_.later_level_is_finer(number)) {
        continue;
      }
      if (number == options_.levels || !go_on()) break;
    }
    split_ = kept_;
    for (const Triangle& t : placed()) outcome_.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
    for (const auto& [k, e] : edges_) measure_error(k, e);
    const bool is_at_end = outcome_.levels == options_.levels;
    outcome_.stop_reason = is_out_of_budget ? StopReason::budget
                           : is_at_end      ? StopReason::levels
                                            : StopReason::converged;
    if (reaches_targets()) outcome_.stop_reason = StopReason::converged;
    return outcome_;
  }

 private:
  [[nodiscard]] bool reaches_targets() const {
    const double pixels = options_.view ? options_.view->error_pixels : 0;
    const bool is_any_requested = options_.tolerance > 0 || pixels > 0;
    return is_any_requested && !(options_.tolerance > 0 && outcome_.error > options_.tolerance) &&
           !(pixels > 0 && outcome_.error_pixels > pixels);
  }

  using Key = std::pair<size_t, uint32_t>;  ///< level, and a face or an edge of it

  [[nodiscard]] size_t deepest() const { return levels_.size() - 1; }
  [[nodiscard]] const Surface& surface(size_t k) const { return levels_[k].s; }
  [[nodiscard]] Vec3d vertex(uint32_t v) const { return levels_.back().at[v]; }
  /// Returns the split sides of a face: bit i for side i.
  [[nodiscard]] unsigned mask(size_t k, uint32_t f) const {
    const auto& [i, j, l] = surface(k).sides[f];
    return split_.contains({k, i}) | split_.contains({k, j}) << 1U | split_.contains({k, l}) << 2U;
  }
  [[nodiscard]] std::vector<uint32_t> faces_of(size_t k) const {
    std::vector<uint32_t> faces;
    for (const auto& [level, f] : faces_)
      if (level == k) faces.push_back(f);
    return faces;
  }
  [[nodiscard]] std::set<uint32_t> edges_of(size_t k) const {
    std::set<uint32_t> edges;
    for (const auto& [level, e] : edges_)
      if (level == k) edges.insert(e);
    return edges;
  }
  void divide(size_t k, uint32_t f) {
    for (uint32_t e : surface(k).sides[f]) split_.insert({k, e});
  }

  /// Begins with all faces and edges of a surface.
  void start(const Surface& s) {
    for (auto* keys : {&faces_, &edges_, &split_, &kept_}) keys->clear();
    error_.clear();
    levels_.assign(1, Level(s, options_, margin_));
    for (uint32_t f = 0; f < s.faces.size(); ++f) faces_.insert({0, f});
    for (uint32_t e = 0; e < s.edges.size(); ++e) edges_.insert({0, e});
  }

  /// Computes the errors of the deepest level's candidate edges that reach the threshold.
  void weigh(int number) {
    const Level& level = levels_.back();
    if (is_in_place_) error_.clear();
    const double least = criteria_.threshold();
    for (uint32_t e : criteria_.candidates(level.s, number, faces_of(deepest()), edges_of(deepest()))) {
      const EdgeError error = criteria_.is_by_error() ? criteria_.error(level.s, e, level.made(e)) : EdgeError{};
      if (least == 0 || !margin_.is_less(error.value, least, error.slope)) error_[{deepest(), e}] = error;
    }
  }

  /// Chooses the edges to split. Returns whether the budget excluded any.
  bool choose() {
    if (!criteria_.is_by_error()) {  // parents are divided already, except at an outline
      for (const auto& [key, error] : error_)
        if (key.first == deepest()) split_.insert(key);
      avoid_slivers(deepest());
      for (size_t k = deepest(); k > 0 && divide_parents(k); --k) avoid_slivers(k - 1);
      return false;
    }
    carry_errors_up();
    threshold_ = criteria_.threshold();
    split_by_threshold();
    if (options_.max_faces == 0) return false;
    uint64_t room = options_.max_faces - surface(0).faces.size();
    for (uint64_t faces = count(); faces > options_.max_faces; faces = count()) {
      double raised = criteria_.threshold_within(error_, room);
      while (raised <= threshold_) {  // faces that avoid slivers exceed the budget: errors get that much less
        room -= std::min(room, faces - options_.max_faces);
        raised = criteria_.threshold_within(error_, room);
      }
      threshold_ = raised;
      split_by_threshold();
    }
    return threshold_ > criteria_.threshold();
  }

  /// Gives the sides of a face at least the errors of its children's edges, which exist only if the sides are split.
  void carry_errors_up() {
    for (const auto& [k, f] : std::views::reverse(faces_))
      for (uint32_t e : surface(k).sides[f]) {
        const auto below = error_.find({k, e});
        for (uint32_t i = 0; i < 3 && k > 0 && below != error_.end(); ++i) {
          const uint32_t side = surface(k - 1).sides[f / 4][i];
          EdgeError& above = error_.try_emplace({k - 1, side}, EdgeError{-1, 0, 0, 0}).first->second;
          if (above.value < below->second.value)
            above = {below->second.value, below->second.slope, surface(k - 1).edges[side].faces.size(), 0};
        }
      }
  }

  /// Splits edges of at least the threshold's error, and what these need: sides of parents, and no slivers.
  void split_by_threshold() {
    split_.clear();
    for (const auto& [key, error] : error_)
      if (error.value >= threshold_) split_.insert(key);
    for (size_t k = levels_.size(); k-- > 0;) {
      avoid_slivers(k);
      divide_parents(k);
    }
  }
  /// Divides the parents of faces with split sides. Returns whether one was not divided.
  bool divide_parents(size_t k) {
    const size_t before = split_.size();
    for (uint32_t f : faces_of(k))
      if (k > 0 && mask(k, f) != 0) divide(k - 1, f / 4);
    return split_.size() > before;
  }

  /// Returns the number of faces of the result.
  [[nodiscard]] uint64_t count() const {
    uint64_t faces = surface(0).faces.size();
    for (const auto& [k, e] : split_) faces += surface(k).edges[e].faces.size();
    return faces;
  }

  /// Divides faces whose pieces would be slivers, until there are none. The result depends on the order.
  void avoid_slivers(size_t k) {
    std::vector<uint32_t> faces = faces_of(k);
    std::erase_if(faces, [&](uint32_t f) { return !has_slivers(k, f); });
    while (!faces.empty()) {
      const Triangle sides = surface(k).sides[faces.back()];
      divide(k, faces.back());
      faces.pop_back();
      for (uint32_t e : sides)
        for (uint32_t f : surface(k).edges[e].faces)
          if (has_slivers(k, f)) {
            faces.push_back(f);
            margin_.is_disputed |= !surface(k).joins(e);
          }
    }
  }
  /// Returns whether a piece has an angle below two fifths of the coarse mesh's smallest, though the face has not.
  bool has_slivers(size_t k, uint32_t f) {
    if (is_in_place_ || mask(k, f) % 7 == 0 || !may_be_divided(k, f)) return false;
    const Level& level = levels_[k];
    const double best = std::min(level.smallest_angle(level.cut(f, mask(k, f), false)),
                                 level.smallest_angle(level.cut(f, mask(k, f), true)));
    return margin_.is_less(most_cosine_, best, 4 * level.s.slope) &&
           !margin_.is_less(most_cosine_, level.smallest_angle({level.s.faces[f]}), level.s.slope);
  }
  [[nodiscard]] bool may_be_divided(size_t k, uint32_t f) const {
    return std::ranges::all_of(surface(k).sides[f], [&](uint32_t e) { return edges_.contains({k, e}); });
  }

  /// Returns the vertices of faces with a large error.
  [[nodiscard]] std::set<uint32_t> touched_by_error(size_t k) {
    std::set<uint32_t> touched;
    const Surface& s = surface(k);
    for (uint32_t f : faces_of(k))
      for (uint32_t e : s.sides[f])
        if (error_.contains({k, e}) && error_[{k, e}].value >= threshold_)
          touched.insert(s.faces[f].begin(), s.faces[f].end());
    return touched;
  }
  /// Returns the vertices with both a candidate edge and a hidden edge of an undivided face: halves of the candidate
  /// edge may be candidates.
  [[nodiscard]] std::set<uint32_t> on_outline(size_t k) const {
    std::set<uint32_t> at_candidates, outline;
    const Surface& s = surface(k);
    for (const auto& [key, error] : error_)
      if (key.first == k && criteria_.is_long(s, key.second, 1.5))
        at_candidates.insert({s.edges[key.second].a, s.edges[key.second].b});
    for (uint32_t f : faces_of(k))
      for (uint32_t e : s.sides[f])
        if (mask(k, f) != 7 && !criteria_.is_shown(s, e))
          for (uint32_t v : {s.edges[e].a, s.edges[e].b})
            if (at_candidates.contains(v)) outline.insert(v);
    return outline;
  }

  /// Adds the next level: the current surface in place, otherwise the children of faces that may be divided.
  bool go_on() {
    const size_t k = deepest();
    const Surface& s = surface(k);
    if (is_in_place_) {
      if (split_.empty()) return false;
      start(levels_[0].below(placed()));
      return true;
    }
    std::vector<uint32_t> faces = faces_of(k);
    const std::set<uint32_t> touched = criteria_.is_by_error() ? touched_by_error(k) : on_outline(k);
    const std::set<uint32_t> curved = criteria_.curved_edges(s, static_cast<int>(k) + 1, faces, edges_of(k));
    const auto is_curved = [&](uint32_t e) { return curved.contains(e); };
    std::erase_if(faces, [&](uint32_t f) {
      const bool is_near = std::ranges::any_of(s.faces[f], [&](uint32_t v) { return touched.contains(v); });
      if (criteria_.is_by_error()) return !is_near || !may_be_divided(k, f);
      if (mask(k, f) == 7) return false;
      return !is_near || !std::ranges::all_of(s.sides[f], is_curved) ||
             std::ranges::none_of(s.sides[f], [&](uint32_t e) {
               return !split_.contains({k, e}) && (!criteria_.is_shown(s, e) || !criteria_.is_long(s, e));
             });
    });
    if (!faces.empty()) deepen(faces);
    return !faces.empty();
  }

  /// Adds the whole next level. Only children of these faces may be refined further.
  void deepen(const std::vector<uint32_t>& parents) {
    std::vector<Triangle> children;
    for (uint32_t f = 0; f < surface(deepest()).faces.size(); ++f)
      for (const Triangle& t : levels_.back().cut(f, 7, false)) children.push_back(t);
    levels_.emplace_back(levels_.back().below(children), options_, margin_);
    const size_t k = deepest();
    for (uint32_t f : parents) faces_.insert({{k, 4 * f}, {k, 4 * f + 1}, {k, 4 * f + 2}, {k, 4 * f + 3}});
    const auto goes_on = [&](uint32_t f) { return faces_.contains({k, f}); };
    for (uint32_t e = 0; e < surface(k).edges.size(); ++e)
      if (std::ranges::all_of(surface(k).edges[e].faces, goes_on)) edges_.insert({k, e});
  }

  /// Returns the faces of the result.
  std::vector<Triangle> placed() {
    std::vector<Triangle> result;
    for (uint32_t f = 0; f < surface(0).faces.size(); ++f) place(0, f, result);
    return result;
  }
  /// Appends the pieces of a face, or those of its children.
  void place(size_t k, uint32_t f, std::vector<Triangle>& result) {
    if (mask(k, f) == 7 && k < deepest()) {
      for (uint32_t child = 4 * f; child < 4 * f + 4; ++child) place(k + 1, child, result);
      return;
    }
    const bool is_second = std::popcount(mask(k, f)) == 2 && is_second_better(k, f);
    for (const Triangle& t : levels_[k].cut(f, mask(k, f), is_second)) result.push_back(t);
  }
  /// Returns whether the second diagonal is better. In place that is the shorter one; else the one with the larger
  /// smallest angle.
  bool is_second_better(size_t k, uint32_t f) {
    const Level& level = levels_[k];
    const std::vector<Triangle> first = level.cut(f, mask(k, f), false);
    const std::vector<Triangle> second = level.cut(f, mask(k, f), true);
    if (!is_in_place_)
      return margin_.is_less(level.smallest_angle(second), level.smallest_angle(first), 4 * level.s.slope);
    const double first_length = length(level.at[first[1][0]] - level.at[first[1][2]]);                 // of a, ab, bc
    return margin_.is_less(length(level.at[second[1][1]] - level.at[second[1][2]]), first_length, 1);  // of a, ab, c
  }

  /// Adds the error left at an edge of the result. Of a split edge, that is the error at its halves where it is known.
  void measure_error(size_t k, uint32_t e) {
    constexpr double split_leaves = 0.25;  // of a deviation, where a smooth surface is split once more
    const auto is_placed = [&](uint32_t f) {
      for (size_t i = k, g = f; i > 0; --i, g /= 4)
        if (mask(i - 1, g / 4) != 7) return false;
      return mask(k, f) != 7 || !faces_.contains({k + 1, 4 * f});
    };
    const Edge& edge = surface(k).edges[e];
    if (std::ranges::none_of(edge.faces, is_placed)) return;
    if (k < deepest() && split_.contains({k, e})) {
      const uint32_t one = surface(k + 1).edge(edge.a, levels_[k].new_vertex(e));
      const uint32_t two = surface(k + 1).edge(edge.b, levels_[k].new_vertex(e));
      if (edges_.contains({k + 1, one}) && edges_.contains({k + 1, two})) {
        if (!criteria_.is_shown(surface(k), e)) return;
        add_error(k + 1, one, 1);
        return add_error(k + 1, two, 1);
      }
    }
    add_error(k, e, split_.contains({k, e}) ? split_leaves : 1);
  }
  void add_error(size_t k, uint32_t e, double share) {
    const double distance = share * surface(k).deviation(e, levels_[k].made(e));
    const double scale = criteria_.pixels_per_unit(surface(k).middle(e));
    outcome_.pixels_per_unit = std::max(outcome_.pixels_per_unit, scale);
    if (distance <= outcome_.error * diagonal_ && distance * scale <= outcome_.error_pixels) return;
    if (!criteria_.is_shown(surface(k), e)) return;
    outcome_.error = std::max(outcome_.error, distance / diagonal_);
    outcome_.error_pixels = std::max(outcome_.error_pixels, distance * scale);
  }

  const Options& options_;
  const Criteria& criteria_;
  const bool is_in_place_;
  const double diagonal_;
  Margin& margin_;
  Outcome outcome_{};
  std::vector<Level> levels_{};       ///< of the uniform subdivision; in place, the surface as it is
  std::set<Key> faces_{}, edges_{};   ///< that may be refined; all faces at these edges are among them
  std::map<Key, EdgeError> error_{};  ///< of candidate edges: their own error or that of descendants
  std::set<Key> split_{}, kept_{};    ///< edges split now, and when a level last changed something
  double most_cosine_ = 1;            ///< of the smallest angle of transition faces
  double threshold_ = 0;
};

/// Makes creases where the normals differ by more than so many degrees.
Surface with_creases(const Surface& s, double degrees, Margin& margin) {
  std::set<Surface::Pair> creases;
  const double limit = std::cos(degrees * std::numbers::pi / 180) - 4e-7;
  for (uint32_t e = 0; e < s.edges.size() && degrees < 180; ++e)
    if (s.joins(e) && margin.is_less(s.cosine(e), limit, s.slope)) creases.insert({s.edges[e].a, s.edges[e].b});
  return {s.at, s.faces, creases};
}

}  // namespace

Outcome refine(const Mesh& mesh, const Options& options) {
  std::vector<Vec3d> at;
  for (const Vec3f& p : mesh.positions) at.push_back(to_double(p));
  const Buffer<Triangle> faces = TriangleMesh(Mesh{mesh.topology, mesh.positions}.triangles()).triangles;
  const Box box = bounding_box(mesh.positions);
  Margin margin{box.largest_coordinate()};
  const Surface coarse = with_creases({at, {faces.begin(), faces.end()}, {}}, options.crease_angle, margin);
  const Criteria criteria(options, box.diagonal(), margin);
  Outcome outcome = Refiner(options, criteria, box.diagonal(), margin).run(coarse);
  outcome.margin = margin.least;
  outcome.is_disputed = margin.is_disputed;
  return outcome;
}

}  // namespace papilio::reference
