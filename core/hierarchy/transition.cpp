#include "hierarchy/transition.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"

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
      return to_double(level.mesh.positions[mesh.origin[3 * face + turned[first + i]]]);
    };
    const auto middle = [&](uint32_t i) { return to_double(level.trial.at(mesh.edge[3 * face + turned[first + i]])); };
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

/// Has the cache load what judge() will read of a face.
void prefetch(const HierarchyLevel& level, uint32_t face) {
  const Topology& mesh = level.mesh.topology;
  for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
    __builtin_prefetch(level.mesh.positions.data() + mesh.origin[h]);
    __builtin_prefetch(level.trial.made.data() + mesh.edge[h]);
  }
}

/// Finds which faces of a choice have slivers among their pieces, in ascending order, and notes what becomes of all.
Buffer<uint32_t> find_slivers(LevelChoice& choice, double most_cosine) {
  constexpr size_t ahead = 16;  // faces until what is asked for is there
  const HierarchyLevel& level = *choice.level;
  if (choice.transitions.empty()) choice.transitions.assign(level.mesh.topology.face_count(), 0);
  const Buffer<LevelChoice::PartlySplit> splits = choice.faces_split_in_part();
  Buffer<uint32_t> slivers;
  for (size_t i = 0; i < splits.size(); ++i) {
    prefetch(level, splits[std::min(i + ahead, splits.size() - 1)].face);
    const auto& [face, mask] = splits[i];
    uint32_t bits = Transition::known(choice, face, mask);
    if (bits == 0) choice.transitions[face] = Transition::with_mask(bits = judge(level, face, mask, most_cosine), mask);
    if ((bits & Transition::has_sliver) != 0) slivers.push_back(face);
  }
  return slivers;
}

}  // namespace

double smallest_angle(const Mesh& mesh) {
  double largest = 0;
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
    const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
    largest = std::max(largest, squared_cosine_of_smallest_angle(corner(0), corner(1), corner(2)));
  }
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
  // The order decides where dividing one makes a sliver of another.
  Buffer<uint32_t> faces = find_slivers(choice, most_cosine);
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
