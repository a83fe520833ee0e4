#include "hierarchy/transition.h"
#include "simd/extremes.h"

#include <cmath>

#include "base/trigonometry.h"

namespace papilio {
namespace {

/// Lower bound of the angles of transition faces, a share of the coarse mesh's smallest angle.
constexpr double sliver_share = 0.4;

double squared_length(Vec3d a) { return dot(a, a); }

/// Returns the squared cosine of a triangle's smallest angle, given its squared sides; 1 if a side has no length. The
/// smallest angle is opposite the shortest side, and at most 60 degrees.
double squared_cosine_of_smallest_angle(double a, double b, double c) {
  // Branch-free: the shortest side is unpredictable.
  const double shorter = lesser(a, b);
  const double shortest = lesser(shorter, c);
  const double one = larger(a, b);
  const double other = larger(shorter, c);
  const double twice_product = one + other - shortest;  // 2 * product of the two longer sides * cosine
  return shortest > 0 ? 0.25 * twice_product * twice_product / (one * other) : 1;
}

/// Face with one or two split edges. The first runs from corner a to b, and has the new vertex `on_ab`; the second, if
/// any, runs from b to c.
struct SplitFace {
  SplitFace(const HierarchyLevel& level, FaceId face, unsigned mask)
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

/// Squared cosines of the smallest angle of a face's pieces, for each diagonal.
struct Cosines {
  double first_diagonal, second_diagonal;
};

/// Computes the cosines of the pieces that split_pattern() makes for masks 1 to 6.
Cosines cosines_of_pieces(const SplitFace& face) {
  const auto& [has_two, first, a, b, c, on_ab, on_bc] = face;
  const double first_half = squared_length(on_ab - a);
  const double second_half = squared_length(b - on_ab);
  const double across = squared_length(c - on_ab);
  const double ca = squared_length(a - c);
  const double beside_a = squared_cosine_of_smallest_angle(first_half, across, ca);
  if (!has_two) {
    const double both = larger(beside_a, squared_cosine_of_smallest_angle(second_half, squared_length(c - b), across));
    return {both, both};
  }
  const double from_b = squared_length(on_bc - b);
  const double to_c = squared_length(c - on_bc);
  const double between = squared_length(on_bc - on_ab);
  const double other_across = squared_length(on_bc - a);
  const double tip = squared_cosine_of_smallest_angle(second_half, from_b, between);
  return {larger(tip, squared_cosine_of_smallest_angle(first_half, between, other_across),
                 squared_cosine_of_smallest_angle(other_across, to_c, ca)),
          larger(tip, beside_a, squared_cosine_of_smallest_angle(between, to_c, across))};
}

/// Returns the squared cosine of a triangle's smallest angle, given its corners.
double squared_cosine_of_smallest_angle(Vec3d a, Vec3d b, Vec3d c) {
  return squared_cosine_of_smallest_angle(squared_length(b - a), squared_length(c - b), squared_length(a - c));
}

/// Returns the faces of a choice with slivers among their pieces, in ascending order. Stores all judged faces in
/// `LevelChoice::transitions`.
Buffer<uint32_t> find_slivers(LevelChoice& choice) {
  if (choice.transitions.empty()) choice.transitions.assign(choice.level->mesh.topology.face_count(), 0);
  Buffer<uint32_t> slivers;
  for (FaceId f : chosen(choice.region.faces, [&](FaceId f) { return (choice.split_mask(f) + 1) % 8 > 1; })) {
    const unsigned mask = choice.split_mask(f);
    const uint32_t bits = Transition::find(choice, f, mask);
    choice.transitions[f] = Transition::with_mask(bits, mask);
    if ((bits & Transition::has_sliver) != 0) slivers.push_back(f);
  }
  return slivers;
}

}  // namespace

double smallest_angle(const Mesh& mesh) {
  double largest = 0;
  for (FaceId f = 0; f < mesh.topology.face_count(); ++f) {
    const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
    largest = larger(largest, squared_cosine_of_smallest_angle(corner(0), corner(1), corner(2)));
  }
  return arc_cosine(std::sqrt(lesser(largest, 1.0)));
}

double most_cosine_beside(double smallest_angle) { return cosine_of_small_angle(sliver_share * smallest_angle); }

uint32_t Transition::judge(const HierarchyLevel& level, FaceId face, unsigned mask) {
  const SplitFace split(level, face, mask);
  uint32_t found = 0;
  const auto [cosine_of_first, second] = cosines_of_pieces(split);
  double cosine = cosine_of_first;
  if (split.has_two) {
    const uint32_t* corner = &level.mesh.topology.origin[size_t{3} * face];
    const bool second_is_lower = corner[(split.first + 2) % 3] < corner[split.first];
    if (second < cosine || (second == cosine && second_is_lower)) found |= second_diagonal;
    cosine = lesser(cosine, second);
  }
  const double most = level.most_cosine * level.most_cosine;
  if (cosine > most && squared_cosine_of_smallest_angle(split.a, split.b, split.c) <= most) found |= has_sliver;
  return found;
}

void avoid_slivers(LevelChoice& choice) {
  if (choice.split_edges.empty()) return;
  const Topology& mesh = choice.level->mesh.topology;
  const auto must_be_divided = [&](FaceId f) {
    const unsigned mask = choice.split_mask(f);
    return mask != 0 && mask != 7 && (Transition::find(choice, f, mask) & Transition::has_sliver) != 0 &&
           choice.may_divide(f);
  };
  // The result depends on the order of faces: dividing one may make a sliver in another.
  Buffer<uint32_t> faces = find_slivers(choice);
  erase_if(faces, [&](FaceId f) { return !must_be_divided(f); });
  while (!faces.empty()) {
    const FaceId f = faces.back();
    faces.pop_back();
    choice.divide(f);
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h)
      if (const HalfEdgeId t = mesh.twin[h]; t != none && must_be_divided(t.face())) faces.push_back(t.face());
  }
}

}  // namespace papilio
