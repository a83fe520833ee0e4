#include "transition.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace papilio {
namespace {

/// No transition face gets an angle smaller than this share of the coarse mesh's smallest.
constexpr double sliver_share = 0.4;

/// The face's corners and, where an edge is in `mask`, its new vertex, numbered as in SplitPattern.
std::array<Vec3d, 6> local_points(const HierarchyLevel& level, uint32_t face, unsigned mask) {
  const Topology& mesh = level.mesh.topology;
  std::array<Vec3d, 6> points;
  for (uint32_t i = 0; i < 3; ++i) {
    points[i] = to_double(level.mesh.positions[mesh.origin[3 * face + i]]);
    if ((mask >> i & 1U) != 0) points[3 + i] = to_double(level.trial.at(mesh.edge[3 * face + i]));
  }
  return points;
}

double squared_length(Vec3d a) { return dot(a, a); }

/// The cosine of a triangle's smallest angle, squared, from the squares of its sides. That angle is opposite the
/// shortest side, and not above 60 degrees; 1 for a triangle without area that has a side of no length.
double squared_cosine_of_smallest_angle(double a, double b, double c) {
  if (b < a) std::swap(a, b);
  if (c < a) std::swap(a, c);
  const double twice_product = b + c - a;  // of the other sides, with the cosine
  return a > 0 ? 0.25 * twice_product * twice_product / (b * c) : 1;
}

/// That of the smallest angle of a face's pieces, for each way to cut it.
struct Cosines {
  double first_diagonal, second_diagonal;
};

/// The pieces are those of split_pattern(mask, ...), for masks 1 to 6. What they share is computed once.
Cosines cosines_of_pieces(unsigned mask, const std::array<Vec3d, 6>& points) {
  const bool has_two = std::popcount(mask) == 2;
  const uint32_t i = has_two ? first_of_two_targets(mask) : static_cast<uint32_t>(std::countr_zero(mask));
  const Vec3d& a = points[i];
  const Vec3d& b = points[(i + 1) % 3];
  const Vec3d& c = points[(i + 2) % 3];
  const Vec3d& on_ab = points[3 + i];
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
  const Vec3d& on_bc = points[3 + (i + 1) % 3];
  const double from_b = squared_length(on_bc - b);
  const double to_c = squared_length(c - on_bc);
  const double between = squared_length(on_bc - on_ab);
  const double other_across = squared_length(on_bc - a);
  const double tip = squared_cosine_of_smallest_angle(second_half, from_b, between);
  return {std::max({tip, squared_cosine_of_smallest_angle(first_half, between, other_across),
                    squared_cosine_of_smallest_angle(other_across, to_c, ca)}),
          std::max({tip, beside_a, squared_cosine_of_smallest_angle(between, to_c, across)})};
}

/// That of the face itself.
double squared_cosine_of_smallest_angle(Vec3d a, Vec3d b, Vec3d c) {
  return squared_cosine_of_smallest_angle(squared_length(b - a), squared_length(c - b), squared_length(a - c));
}

// What is known of a face's transitions: three bits a mask, of which the lowest says whether the others are known.
enum : uint32_t { is_known = 1, second_diagonal = 2, has_sliver = 4 };

uint32_t judge(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  const std::array<Vec3d, 6> points = local_points(level, face, mask);
  uint32_t found = is_known;
  const Cosines cosines = cosines_of_pieces(mask, points);
  double cosine = cosines.first_diagonal;
  if (std::popcount(mask) == 2) {
    const double second = cosines.second_diagonal;
    const uint32_t i = first_of_two_targets(mask);
    const auto& origin = level.mesh.topology.origin;
    const bool second_is_lower = origin[3 * face + (i + 2) % 3] < origin[3 * face + i];
    if (second < cosine || (second == cosine && second_is_lower)) {
      found |= second_diagonal;
      cosine = second;
    }
  }
  const double most = most_cosine * most_cosine;
  if (cosine > most && squared_cosine_of_smallest_angle(points[0], points[1], points[2]) <= most) found |= has_sliver;
  return found;
}

/// For masks 1 to 6.
uint32_t transition(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  const unsigned shift = 3 * (mask - 1);
  const uint32_t known = level.transitions.get(face);
  if ((known >> shift & is_known) != 0) return known >> shift;
  const uint32_t found = judge(level, face, mask, most_cosine);
  level.transitions.put(face, known | found << shift);
  return found;
}

}  // namespace

double smallest_angle(const Mesh& mesh) {
  double largest = 0;
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
    const auto at = [&](uint32_t corner) { return to_double(mesh.positions[mesh.topology.origin[3 * f + corner]]); };
    largest = std::max(largest, squared_cosine_of_smallest_angle(at(0), at(1), at(2)));
  }
  return std::acos(std::sqrt(std::min(largest, 1.0)));
}

double most_cosine_beside(double smallest_angle) { return std::cos(sliver_share * smallest_angle); }

uint8_t choose_transition(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  if (mask == 0 || mask == 7) return static_cast<uint8_t>(2 * mask);
  return static_cast<uint8_t>(2 * mask + ((transition(level, face, mask, most_cosine) & second_diagonal) != 0 ? 1 : 0));
}

void avoid_slivers(LevelChoice& choice, double most_cosine) {
  if (choice.split_edges.empty()) return;
  const HierarchyLevel& level = *choice.level;
  const Topology& mesh = level.mesh.topology;
  const auto must_be_divided = [&](uint32_t f) {
    const unsigned mask = choice.split_mask(f);
    return mask != 0 && mask != 7 && choice.may_divide(f) &&
           (transition(level, f, mask, most_cosine) & has_sliver) != 0;
  };
  List<uint8_t> is_at_split(mesh.face_count(), 0);
  choice.visit_faces_of_split([&](uint32_t f, uint32_t) { is_at_split[f] = 1; });
  List<uint32_t> faces = marked(is_at_split);  // the order decides where dividing one makes a sliver of another
  std::erase_if(faces, [&](uint32_t f) { return !must_be_divided(f); });
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
