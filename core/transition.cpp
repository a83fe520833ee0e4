#include "transition.h"

#include <algorithm>
#include <array>
#include <cmath>

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

double cosine(Vec3d u, Vec3d v) {
  const double size = length(u) * length(v);
  return size > 0 ? dot(u, v) / size : 1;
}

/// Cosine of the smallest angle of the pattern's pieces.
double smallest_angle_cosine(const SplitPattern& pattern, const std::array<Vec3d, 6>& points) {
  double largest = -1;
  for (uint32_t c = 0; c < pattern.children; ++c)
    for (uint32_t i = 0; i < 3; ++i) {
      const Vec3d at = points[pattern.corner[c][i]];
      largest = std::max(
          largest, cosine(points[pattern.corner[c][(i + 1) % 3]] - at, points[pattern.corner[c][(i + 2) % 3]] - at));
    }
  return largest;
}

// What is known of a face's transitions: three bits a mask, of which the lowest says whether the others are known.
enum : uint32_t { is_known = 1, second_diagonal = 2, has_sliver = 4 };

uint32_t judge(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  const std::array<Vec3d, 6> points = local_points(level, face, mask);
  uint32_t found = is_known;
  double cosine = smallest_angle_cosine(split_pattern(mask, false), points);
  if (mask == 3 || mask == 5 || mask == 6) {
    const double second = smallest_angle_cosine(split_pattern(mask, true), points);
    const uint32_t i = first_of_two_targets(mask);
    const auto& origin = level.mesh.topology.origin;
    const bool second_is_lower = origin[3 * face + (i + 2) % 3] < origin[3 * face + i];
    if (second < cosine || (second == cosine && second_is_lower)) {
      found |= second_diagonal;
      cosine = second;
    }
  }
  if (cosine > most_cosine && smallest_angle_cosine(split_pattern(0, false), points) <= most_cosine)
    found |= has_sliver;
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
  double largest = -1;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const auto at = [&](uint32_t v) { return to_double(mesh.positions[v]); };
    const Vec3d corner = at(mesh.topology.origin[h]);
    largest = std::max(largest, cosine(at(mesh.topology.tip(h)) - corner, at(mesh.topology.apex(h)) - corner));
  }
  return std::acos(std::min(largest, 1.0));
}

double most_cosine_beside(double smallest_angle) { return std::cos(sliver_share * smallest_angle); }

uint8_t choose_transition(const HierarchyLevel& level, uint32_t face, unsigned mask, double most_cosine) {
  if (mask == 0 || mask == 7) return static_cast<uint8_t>(2 * mask);
  return static_cast<uint8_t>(2 * mask + ((transition(level, face, mask, most_cosine) & second_diagonal) != 0 ? 1 : 0));
}

void avoid_slivers(LevelChoice& choice, double most_cosine) {
  const HierarchyLevel& level = *choice.level;
  const Topology& mesh = level.mesh.topology;
  const auto must_be_divided = [&](uint32_t f) {
    const unsigned mask = choice.split_mask(f);
    return mask != 0 && mask != 7 && choice.may_divide(f) &&
           (transition(level, f, mask, most_cosine) & has_sliver) != 0;
  };
  std::vector<uint32_t> faces;
  choice.visit_faces_of_split([&](uint32_t f, uint32_t) {
    if (must_be_divided(f)) faces.push_back(f);
  });
  std::ranges::sort(faces);  // the order decides where dividing one makes a sliver of another
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
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
