#include "hierarchy/transition.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/trigonometry.h"
#include "simd/float4.h"

namespace papilio {
namespace {

/// No transition face gets an angle smaller than this share of the coarse mesh's smallest.
constexpr double sliver_share = 0.4;

double squared_length(Vec3d a) { return dot(a, a); }

/// The cosine of a triangle's smallest angle, squared, from the squares of its sides. That angle is opposite the
/// shortest side, and not above 60 degrees; 1 for a triangle without area that has a side of no length.
double squared_cosine_of_smallest_angle(double a, double b, double c) {
  // Which is the shortest nobody can guess: so without branches.
  const double shorter = std::min(a, b);
  const double shortest = std::min(shorter, c);
  const double one = std::max(a, b);
  const double other = std::max(shorter, c);
  const double twice_product = one + other - shortest;  // of the two, with the cosine
  return shortest > 0 ? 0.25 * twice_product * twice_product / (one * other) : 1;
}

/// A face seen from the first edge that is split: it runs from corner a to b, and its new vertex is `on_ab`; where two
/// are split the next is the second.
struct SplitFace {
  SplitFace(const HierarchyLevel& level, uint32_t face, unsigned mask)
      : has_two(has_two_targets(mask)), first(first_target[mask]) {
    const Topology& mesh = level.mesh.topology;
    const auto corner = [&](uint32_t i) {
      return to_double(level.mesh.positions[mesh.origin[3 * face + (first + i) % 3]]);
    };
    const auto middle = [&](uint32_t i) { return to_double(level.trial.at(mesh.edge[3 * face + (first + i) % 3])); };
    a = corner(0);
    b = corner(1);
    c = corner(2);
    on_ab = middle(0);
    if (has_two) on_bc = middle(1);
  }

  bool has_two;
  uint32_t first;
  Vec3d a, b, c, on_ab, on_bc;
};

/// That of the smallest angle of a face's pieces, for each way to cut it.
struct Cosines {
  double first_diagonal, second_diagonal;
};

/// The pieces are those of split_pattern(mask, ...), for masks 1 to 6. What they share is computed once.
Cosines cosines_of_pieces(const SplitFace& face) {
  const auto& [has_two, first, a, b, c, on_ab, on_bc] = face;
  const double first_half = squared_length(on_ab - a);
  const double second_half = squared_length(b - on_ab);
  const double across = squared_length(c - on_ab);
  const double ca = squared_length(a - c);
  const double beside_a = squared_cosine_of_smallest_angle(first_half, across, ca);
  if (!has_two) {
    const double both =
        std::max(beside_a, squared_cosine_of_smallest_angle(second_half, squared_length(c - b), across));
    return {both, both};
  }
  const double from_b = squared_length(on_bc - b);
  const double to_c = squared_length(c - on_bc);
  const double between = squared_length(on_bc - on_ab);
  const double other_across = squared_length(on_bc - a);
  const double tip = squared_cosine_of_smallest_angle(second_half, from_b, between);
  return {std::max({tip, squared_cosine_of_smallest_angle(first_half, between, other_across),
                    squared_cosine_of_smallest_angle(other_across, to_c, ca)}),
          std::max({tip, beside_a, squared_cosine_of_smallest_angle(between, to_c, across)})};
}

/// That of a face itself.
double squared_cosine_of_smallest_angle(Vec3d a, Vec3d b, Vec3d c) {
  return squared_cosine_of_smallest_angle(squared_length(b - a), squared_length(c - b), squared_length(a - c));
}

uint32_t judge(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  const SplitFace split(level, face, mask);
  uint32_t found = Transition::is_known;
  const auto [cosine_of_first, second] = cosines_of_pieces(split);
  double cosine = cosine_of_first;
  if (split.has_two) {
    const uint32_t* corner = &level.mesh.topology.origin[size_t{3} * face];
    const bool second_is_lower = corner[(split.first + 2) % 3] < corner[split.first];
    if (second < cosine || (second == cosine && second_is_lower)) found |= Transition::second_diagonal;
    cosine = std::min(cosine, second);
  }
  const double most = most_cosine * most_cosine;
  if (cosine > most && squared_cosine_of_smallest_angle(split.a, split.b, split.c) <= most)
    found |= Transition::has_sliver;
  return found;
}

/// Judges faces with alike masks four at a time, in floats: as far as that is certain, as judge() does.
class FourJudge {
 public:
  FourJudge(const HierarchyLevel& level, double most_cosine)
      : level_(level), mesh_(level.mesh.topology), most_(static_cast<float>(most_cosine * most_cosine)) {}

  using Split = LevelChoice::PartlySplit;
  /// What judge() finds, of four faces all of which have one or all two split edges; 0 where that is not certain.
  [[nodiscard]] std::array<uint32_t, 4> find(const std::array<Split, 4>& splits, bool has_two) const {
    const std::array<Index4, 3> side = sides(splits);
    const Vec3x4 a = corners(side[0]);
    const Vec3x4 b = corners(side[1]);
    const Vec3x4 c = corners(side[2]);
    const Vec3x4 on_ab = middles(side[0]);
    const Float4 first_half = squared_length(on_ab - a);
    const Float4 second_half = squared_length(b - on_ab);
    const Float4 across = squared_length(c - on_ab);
    const Float4 ab = squared_length(b - a);
    const Float4 bc = squared_length(c - b);
    const Float4 ca = squared_length(a - c);
    const Float4 beside_a = squared_cosine(first_half, across, ca);
    auto are_usual =
        is_usual(ab) & is_usual(bc) & is_usual(ca) & is_usual(first_half) & is_usual(second_half) & is_usual(across);
    Float4 first{}, second{};
    if (has_two) {
      const Vec3x4 on_bc = middles(side[1]);
      const Float4 from_b = squared_length(on_bc - b);
      const Float4 to_c = squared_length(c - on_bc);
      const Float4 between = squared_length(on_bc - on_ab);
      const Float4 other_across = squared_length(on_bc - a);
      const Float4 tip = squared_cosine(second_half, from_b, between);
      are_usual &= is_usual(from_b) & is_usual(to_c) & is_usual(between) & is_usual(other_across);
      first = larger(tip,
                     larger(squared_cosine(first_half, between, other_across), squared_cosine(other_across, to_c, ca)));
      second = larger(tip, larger(beside_a, squared_cosine(between, to_c, across)));
    } else {
      first = second = larger(beside_a, squared_cosine(second_half, bc, across));
    }
    const Float4 cosine = lesser(first, second);
    const Float4 own = squared_cosine(ab, bc, ca);
    const Float4 most = Float4{} + most_;
    const auto prefers_first = is_surely_less(first, second);
    const auto prefers_second = is_surely_less(second, first);
    const auto is_sliver = is_surely_less(most, cosine) & is_surely_less(own, most);
    const auto is_none = is_surely_less(cosine, most) | is_surely_less(most, own);
    auto are_certain = are_usual & (is_sliver | is_none);
    Mask4 found = (Mask4{} + int{Transition::is_known}) | (is_sliver & int{Transition::has_sliver});
    if (has_two) {
      are_certain &= prefers_first | prefers_second;
      found |= prefers_second & int{Transition::second_diagonal};
    }
    return std::bit_cast<std::array<uint32_t, 4>>(found & are_certain);
  }

  /// Whether the squared cosine of the smallest angle may be larger than `most`, of each of four faces from `first` on.
  [[nodiscard]] static std::array<bool, 4> may_have_larger(const Mesh& mesh, uint32_t first, double most) {
    const uint32_t* corner = &mesh.topology.origin[size_t{3} * first];
    const Vec3x4 a = at(mesh.positions, {corner[0], corner[3], corner[6], corner[9]});
    const Vec3x4 b = at(mesh.positions, {corner[1], corner[4], corner[7], corner[10]});
    const Vec3x4 c = at(mesh.positions, {corner[2], corner[5], corner[8], corner[11]});
    const Float4 ab = squared_length(b - a);
    const Float4 bc = squared_length(c - b);
    const Float4 ca = squared_length(a - c);
    const auto are_less = is_usual(ab) & is_usual(bc) & is_usual(ca) &
                          is_surely_less(squared_cosine(ab, bc, ca), Float4{} + static_cast<float>(most));
    if (is_all(are_less)) [[likely]]
      return {};
    return {are_less[0] == 0, are_less[1] == 0, are_less[2] == 0, are_less[3] == 0};
  }

  /// Has the cache load what find() will read of a face.
  void prefetch(const Split& split) const {
    const uint32_t first = first_target[split.mask];
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t h = 3 * split.face + (first + i) % 3;
      __builtin_prefetch(level_.mesh.positions.data() + mesh_.origin[h]);
      if (i < 2) __builtin_prefetch(level_.trial.made.data() + mesh_.edge[h]);
    }
  }

 private:
  /// Of two numbers as squared_cosine() gives them, with more room than rounding takes.
  [[nodiscard]] static Mask4 is_surely_less(Float4 a, Float4 b) { return a < (1 - 2e-5F) * b; }
  [[nodiscard]] static Float4 squared_length(const Vec3x4& a) { return dot(a, a); }
  /// squared_cosine_of_smallest_angle(), of usual numbers.
  [[nodiscard]] static Float4 squared_cosine(Float4 a, Float4 b, Float4 c) {
    const Float4 shorter = lesser(a, b);
    const Float4 shortest = lesser(shorter, c);
    const Float4 one = larger(a, b);
    const Float4 other = larger(shorter, c);
    const Float4 twice_product = one + other - shortest;
    return 0.25F * twice_product * twice_product / (one * other);
  }

  /// The half-edges of the faces, [i] of each the i-th from the first that is split.
  [[nodiscard]] static std::array<Index4, 3> sides(const std::array<Split, 4>& splits) {
    std::array<Index4, 3> side;
    for (size_t k = 0; k < 4; ++k) {
      const uint8_t* first = &turned[first_target[splits[k].mask]];
      for (size_t i = 0; i < 3; ++i) side[i][k] = 3 * splits[k].face + first[i];
    }
    return side;
  }
  /// Where these half-edges of the four faces begin.
  [[nodiscard]] Vec3x4 corners(const Index4& h) const {
    const auto& origin = mesh_.origin;
    return at(level_.mesh.positions, {origin[h[0]], origin[h[1]], origin[h[2]], origin[h[3]]});
  }
  /// The new vertices on them.
  [[nodiscard]] Vec3x4 middles(const Index4& h) const {
    const auto& edge = mesh_.edge;
    return at(level_.trial.made, {edge[h[0]], edge[h[1]], edge[h[2]], edge[h[3]]});
  }

  const HierarchyLevel& level_;
  const Topology& mesh_;
  float most_;
};

/// Finds which faces of a choice would have slivers among their pieces, and notes what becomes of the others.
class SliverFinder {
 public:
  SliverFinder(LevelChoice& choice, double most_cosine)
      : choice_(choice), level_(*choice.level), judge_four_(level_, most_cosine), most_cosine_(most_cosine) {}

  /// In ascending order.
  Buffer<uint32_t> run() {
    for (const auto& [f, mask] : choice_.faces_split_in_part()) {
      const uint32_t known = Transition::known(choice_, f, mask);
      if (known == 0)
        judge_later({f, mask});
      else if ((known & Transition::has_sliver) != 0)
        with_sliver_.push_back(f);
    }
    for (Waiting& waiting : waiting_) judge(waiting);
    std::ranges::sort(with_sliver_);
    return std::move(with_sliver_);
  }

 private:
  using Split = FourJudge::Split;
  /// Faces with alike masks. What they are judged by comes into the cache while they wait for more.
  struct Waiting {
    std::array<Split, 64> splits;
    size_t count = 0;
  };

  void judge_later(const Split& split) {
    judge_four_.prefetch(split);
    Waiting& waiting = waiting_[has_two_targets(split.mask) ? 1 : 0];
    waiting.splits[waiting.count++] = split;
    if (waiting.count == waiting.splits.size()) judge(waiting);
  }

  void judge(Waiting& waiting) {
    if (waiting.count == 0) return;
    const size_t count = (waiting.count + 3) / 4 * 4;
    std::fill(waiting.splits.begin() + waiting.count, waiting.splits.begin() + count, waiting.splits[0]);
    std::array<std::array<uint32_t, 4>, 16> found;
    const auto splits = [&](size_t i) {
      return std::array<Split, 4>{waiting.splits[i], waiting.splits[i + 1], waiting.splits[i + 2],
                                  waiting.splits[i + 3]};
    };
    if (has_two_targets(waiting.splits[0].mask))
      for (size_t i = 0; i < count; i += 4) found[i / 4] = judge_four_.find(splits(i), true);
    else
      for (size_t i = 0; i < count; i += 4) found[i / 4] = judge_four_.find(splits(i), false);
    for (size_t i = 0; i < waiting.count; ++i) {
      const auto& [f, mask] = waiting.splits[i];
      uint32_t is = found[i / 4][i % 4];
      if (is == 0) [[unlikely]]
        is = papilio::judge(level_, f, mask, most_cosine_);
      choice_.transitions[f] = Transition::with_mask(is, mask);
      if ((is & Transition::has_sliver) != 0) with_sliver_.push_back(f);
    }
    waiting.count = 0;
  }

  LevelChoice& choice_;
  const HierarchyLevel& level_;
  const FourJudge judge_four_;
  double most_cosine_;
  std::array<Waiting, 2> waiting_;  ///< those with one split edge, and those with two
  Buffer<uint32_t> with_sliver_;
};

}  // namespace

double smallest_angle(const Mesh& mesh) {
  double largest = 0;
  const auto look_at = [&](uint32_t f) {
    const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
    largest = std::max(largest, squared_cosine_of_smallest_angle(corner(0), corner(1), corner(2)));
  };
  const uint32_t count = mesh.topology.face_count();
  const uint32_t in_fours = count / 4 * 4;
  for (uint32_t f = 0; f < in_fours; f += 4) {
    const std::array<bool, 4> may_be_smallest = FourJudge::may_have_larger(mesh, f, largest);
    for (uint32_t i = 0; i < 4; ++i)
      if (may_be_smallest[i]) [[unlikely]]
        look_at(f + i);
  }
  for (uint32_t f = in_fours; f < count; ++f) look_at(f);
  return arc_cosine(std::sqrt(std::min(largest, 1.0)));
}

double most_cosine_beside(double smallest_angle) { return cosine_of_small_angle(sliver_share * smallest_angle); }

uint32_t Transition::find(const LevelChoice& choice, uint32_t face, unsigned mask, double most_cosine) {
  const uint32_t bits = known(choice, face, mask);
  return bits != 0 ? bits : judge(*choice.level, face, mask, most_cosine);
}

void avoid_slivers(LevelChoice& choice, double most_cosine) {
  if (choice.split_edges.empty()) return;
  const Topology& mesh = choice.level->mesh.topology;
  const auto must_be_divided = [&](uint32_t f) {
    const unsigned mask = choice.split_mask(f);
    return mask != 0 && mask != 7 && (Transition::find(choice, f, mask, most_cosine) & Transition::has_sliver) != 0 &&
           choice.may_divide(f);
  };
  choice.find_masks();
  if (choice.transitions.empty()) choice.transitions.assign(mesh.face_count(), 0);
  // The order decides where dividing one makes a sliver of another.
  Buffer<uint32_t> faces = SliverFinder(choice, most_cosine).run();
  erase_if(faces, [&](uint32_t f) { return !must_be_divided(f); });
  while (!faces.empty()) {
    const uint32_t f = faces.back();
    faces.pop_back();
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) choice.split_edge(mesh.edge[h]);
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      if (const uint32_t t = mesh.twin[h]; t != none && must_be_divided(Topology::face(t)))
        faces.push_back(Topology::face(t));
  }
}

}  // namespace papilio
