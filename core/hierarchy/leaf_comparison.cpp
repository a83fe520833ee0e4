#include "hierarchy/leaf_comparison.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/move_bounds.h"
#include "simd/extremes.h"

namespace papilio {
namespace {

constexpr double share_of_sum = 0.25;  ///< of a move and its rest: what levels that are not explored add
constexpr double share_of_rest = 0.5;  ///< of a move: all further ones add up to a third where the surface is smooth
constexpr double along_diagonal = 2;  ///< a transition face's diagonal may be further away than the whole face would be
constexpr uint32_t leaves_between_polls = 1024;
constexpr int most_divisions = 10;  ///< of a way
/// Share of the limit. The middle of a part is further away than its ends by at most half of its length.
constexpr double squared_length_of_part = 0.06 * 0.06;

/// Corners of each child of a face; the face's new vertices from 3 on.
constexpr std::array<std::array<uint32_t, 3>, 4> corners_of_child{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

}  // namespace

Buffer<LevelFace> LeafComparison::far_faces(NearFaces& near, uint32_t first, uint32_t last) {
  begin_with(1);
  stops_at_limit_ = true;
  Buffer<LevelFace> far;
  visit_leaves(first, last, [&](const LevelFace& leaf) {
    uint8_t& is_near = near[leaf.level][leaf.face];
    if (is_near != 0 || is_surely_near(leaf)) return;
    compare(leaf);
    if (is_far_)
      far.push_back(leaf);
    else
      is_near = 1;
  });
  return far;
}

bool LeafComparison::exceeds(double share, uint32_t first, uint32_t last) {
  begin_with(share);
  stops_at_limit_ = true;
  is_far_ = false;
  visit_leaves(first, last, [&](const LevelFace& leaf) {
    if (!is_far_ && !is_surely_near(leaf)) compare(leaf);
  });
  return is_far_;
}

double LeafComparison::largest_share(double known, uint32_t first, uint32_t last) {
  begin_with(known);
  visit_leaves(first, last, [&](const LevelFace& leaf) {
    if (!is_surely_near(leaf)) compare(leaf);
  });
  return has_grown_ ? std::sqrt(squared_share_) : known;
}

double LeafComparison::largest_bound(uint32_t first, uint32_t last) {
  double most = 0;
  visit_leaves(first, last, [&](const LevelFace& leaf) { most = larger(most, bound_at(leaf) / allowed_.at(leaf)); });
  return most;
}

void LeafComparison::begin_with(double share) {
  squared_share_ = limit_ = share * share;
  allowed_here_ = 1;
  has_grown_ = false;
}

/// Sets the limit to the allowed distance at a leaf.
void LeafComparison::go_to(const LevelFace& leaf) {
  leaf_ = leaf;
  is_far_ = false;
  near_.go_to(leaf);
  const double allowed = allowed_.at(leaf);
  if (allowed == allowed_here_ || allowed == AllowedDistance::any) return;
  limit_ = squared_share_ * allowed * allowed;
  allowed_here_ = allowed;
}

template <class Visit>
void LeafComparison::visit_leaves(uint32_t first, uint32_t last, const Visit& visit) {
  for (FaceId f = first; f < last; ++f) visit_leaves({0, f}, visit);
}

template <class Visit>
void LeafComparison::visit_leaves(const LevelFace& face, const Visit& visit) {
  const auto [k, f] = face;
  if (!result_.is_divided(k, f)) {
    if (++visited_ % leaves_between_polls == 0 && progress_ != nullptr) progress_->poll();
    visit(face);
    return;
  }
  const uint32_t child = result_.first_child(k, f);
  for (uint32_t c = 0; c < 4; ++c) visit_leaves({k + 1, child + c}, visit);
}

/// Upper bound of the distance at a leaf.
double LeafComparison::bound_at(const LevelFace& leaf) const {
  const double sum = sums_[leaf.level][leaf.face];
  return result_.choice(leaf.level).split_mask(leaf.face) == 0 ? sum : along_diagonal * sum;
}

bool LeafComparison::is_surely_near(const LevelFace& leaf) const {
  const double bound = bound_at(leaf) * (allowed_here_ / allowed_.at(leaf));
  return bound * bound <= limit_;
}

void LeafComparison::compare(const LevelFace& leaf) {
  go_to(leaf);
  const auto [k, f] = leaf;
  const unsigned mask = result_.choice(k).split_mask(f);
  const Corners corner = result_.corners(k, f);
  const Corners made = result_.new_vertices(k, f, corner);
  Corners middle = middles_of(corner);
  for (uint32_t i = 0; i < 3; ++i)
    if ((mask >> i & 1U) != 0) middle[i] = made[i];
  compare({.level = k, .face = f, .corner = corner, .made = made, .middle = middle},
          {{{corner[0], 0}, {corner[1], 0}, {corner[2], 0}}}, patches_over_leaf(result_, leaf, {corner, made, middle}));
}

void LeafComparison::compare_below(uint32_t k, FaceId f, const Patch& patch, const Points& corner) {
  const Corners at = result_.corners(k, f);
  const Corners made = result_.new_vertices(k, f, at);
  const Corners middle = patch.middles();
  compare({.level = k, .face = f, .corner = at, .made = made, .middle = middle}, corner, patches_below(patch, middle));
}

void LeafComparison::compare(const Face& face, const Points& corner, const Patches& below) {
  if (result_.has_children(face.level, face.face))
    compare_children(face, corner, below);
  else
    compare_new_faces(face, corner, below);
}

/// Returns a face's corners, and its new vertices with pieces within the root of `enough` if there are any. Notes their
/// distances.
LeafComparison::SixPoints LeafComparison::points_of(const Face& face, const Points& corner, double enough) {
  SixPoints points{corner[0], corner[1], corner[2]};
  for (uint32_t i = 0; i < 3; ++i) {
    points[3 + i] = find_near(face.made[i], face.middle[i], enough);
    note(points[3 + i].squared);
  }
  return points;
}

/// Compares the new faces of a face without children.
void LeafComparison::compare_new_faces(const Face& face, const Points& corner, const Patches& below) {
  const auto [k, f] = LevelFace{face.level, face.face};
  const std::array<Corners, 4> children = children_of(face.corner, face.made);
  const bool is_finest = k + 1 >= level_count_;
  const double rest = stops_at_limit_ && !is_finest ? share_of_sum * sums_[k][f] : 0;
  unsigned open = 0;  // children, by bits
  for (uint32_t c = 0; c < 4; ++c) {
    rest_ = rest;
    if (!is_surely_near({k, f, children[c]}, below[c])) open |= 1U << c;
  }
  rest_ = rest;
  if (open != 0) {
    rest_ = 0;
    SixPoints points = points_of(face, corner, limit_);
    rest_ = rest;
    for (uint32_t c = 0; c < 4; ++c)
      if ((open >> c & 1U) != 0) compare_patch({k, f, children[c]}, below[c]);
    compare_sides(points, open);
  }
  if (!is_finest && !stops_at_limit_) add_rest(face, below);
}

/// Descends into those children below which a distance may matter.
void LeafComparison::compare_children(const Face& face, const Points& corner, const Patches& below) {
  const std::array<Corners, 4> children = children_of(face.corner, face.made);
  const uint32_t level = face.level + 1;
  const uint32_t child = result_.first_child(face.level, face.face);
  unsigned open = 0;  // children, by bits
  for (uint32_t c = 0; c < 4; ++c) {
    rest_ = sums_[level][child + c];
    if (enough() == 0 || !is_surely_near({face.level, face.face, children[c]}, below[c])) open |= 1U << c;
  }
  if (open == 0) return;
  rest_ = largest_sum_below(face.level, face.face);
  const double settled = enough() > 0 ? enough() : limit_;
  rest_ = 0;
  const SixPoints points = points_of(face, corner, settled);
  for (uint32_t c = 0; c < 4 && !is_far_; ++c) {
    const auto [i, j, k] = corners_of_child[c];
    if ((open >> c & 1U) != 0) compare_below(level, child + c, below[c], {points[i], points[j], points[k]});
  }
}

/// Compares a patch with the surface at a child: its centre, and the lines in which the result may be bent.
void LeafComparison::compare_patch(const Child& child, const Patch& patch) {
  if (is_far_) return;
  new_faces_.clear();
  new_faces_.add({child.corner[0], child.corner[1], child.corner[2]});
  const auto near = [&](Vec3d point) {
    PointNear found = new_faces_.find(point, enough());
    if (found.triangle == none) {
      const auto [squared, face] = surface_.nearest({child.level, child.parent}, leaf_.level, point, enough());
      found.squared = squared;
      found.triangle = new_faces_.add({face[0], face[1], face[2]});
    }
    note(found.squared);
    return found;
  };
  const auto compare_line = [&](Vec3d from, Vec3d to) { compare_way(near(from), near(to), 0, new_faces_, near); };
  (void)near(1.0 / 3 * (patch.corner[0] + patch.corner[1] + patch.corner[2]));
  for (uint32_t i = 0; i < 3; ++i)
    if ((patch.ridges >> i & 1U) != 0) compare_line(patch.corner[i], patch.corner[(i + 1) % 3]);
  if (patch.bent_side != none) compare_line(patch.bend, patch.opposite_bend());
}

/// Compares the sides of a face's children, those of `children` by bits, with the result; `points` get their pieces.
/// Between ends near different pieces of the result a side may pass over a valley, where nothing is near. Of a child
/// between two pieces the furthest point is on a side.
void LeafComparison::compare_sides(SixPoints& points, unsigned children) {
  struct Side {
    uint32_t from, to;  // corners; new vertices from 3 on
    unsigned children;  // by bits
  };
  // clang-format off
  static constexpr std::array<Side, 9> sides{{
      {0, 3, 0b0001}, {3, 1, 0b0010}, {1, 4, 0b0010}, {4, 2, 0b0100}, {2, 5, 0b0100}, {5, 0, 0b0001},
      {3, 4, 0b1010}, {4, 5, 0b1100}, {5, 3, 0b1001}}};
  // clang-format on
  const auto at = [&](uint32_t i) -> const PointNear& {
    if (points[i].triangle == none || matters(points[i].squared)) points[i] = near_piece(points[i].point);
    return points[i];
  };
  const auto near = [&](Vec3d point) { return near_piece(point); };
  for (const Side& side : sides)
    if (!is_far_ && (side.children & children) != 0) compare_way(at(side.from), at(side.to), 0, near_.prisms(), near);
}

/// Divides a way on one surface until each part is near a single triangle of the other, or too short to leave it.
/// `near` returns a point with a triangle of `prisms`, and notes its distance.
template <class Near>
void LeafComparison::compare_way(const PointNear& from, const PointNear& to, int depth, const Prisms& prisms,
                                 const Near& near) {
  if (is_far_ || depth == most_divisions) return;
  if (prisms.is_near(from.triangle, to, enough()) || prisms.is_near(to.triangle, from, enough())) return;
  if (squared_norm(to.point - from.point) < squared_length_of_part * enough()) return;
  // Where triangles are nearly in one plane, the way goes from above one to above the next.
  const double end = depth % 2 == 0 ? prisms[from.triangle].end_above(from.point, to.point) : 1;
  const PointNear between = near(from.point + (end < 1 ? end : 0.5) * (to.point - from.point));
  compare_way(from, between, depth + 1, prisms, near);
  compare_way(between, to, depth + 1, prisms, near);
}

/// Returns a point of the surface with a piece of the result that is near enough, if any, and notes the distance.
PointNear LeafComparison::near_piece(Vec3d point) {
  const PointNear found = near_.near(point, enough());
  note(found.squared);
  return found;
}

/// Returns whether a patch is near enough to the surface at a child, without looking for nearest points: its points are
/// compared with those of the same barycentric coordinates. An offset along the child's plane counts by the largest
/// turn of the surface there; then what is below the faces beside counts, too, and raises `rest_`.
bool LeafComparison::is_surely_near(const Child& child, const Patch& patch) {
  if (!matters(largest_squared_distance(patch, child.corner))) return true;
  const Corners& corner = child.corner;
  const Vec3d area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double size = length(area);
  if (!(size > 0)) return false;
  const Vec3d normal = 1 / size * area;
  double height = 0, squared_offset = 0;
  const auto add = [&](Vec3d point, Vec3d at) {
    height = larger(height, std::abs(dot(point - at, normal)));
    squared_offset = larger(squared_offset, squared_norm(point - at));
  };
  for (uint32_t i = 0; i < 3; ++i) add(patch.corner[i], corner[i]);
  if (const uint32_t i = patch.bent_side; i != none) add(patch.bend, middle_of(corner[i], corner[(i + 1) % 3]));
  if (squared_offset > size) return false;  // beyond the faces beside
  const auto [k, f] = LevelFace{child.level, child.parent};
  const Topology& mesh = result_.topology(k);
  const Buffer<Vec3f>& normals = result_.level(k).trial.normals;
  double squared_turn = squared_norm(to_double(normals[f]) - normal);
  for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) {
    const EdgeId e = mesh.edge[h];
    if (mesh.kind[e] != EdgeKind::smooth || result_.choice(k).region.has_edge[e] == 0) return false;
    const FaceId beside = Topology::face(mesh.twin[h]);
    squared_turn = larger(squared_turn, squared_norm(to_double(normals[beside]) - normal));
    rest_ = larger(rest_, largest_sum_below(k, beside));
  }
  const double distance = height + std::sqrt(squared_turn * squared_offset);
  return enough() > 0 && !matters(distance * distance);
}

/// Adds what levels that were not explored may contribute to the distances at a face.
void LeafComparison::add_rest(const Face& face, const Patches& below) {
  const Corners place{below[0].corner[0], below[1].corner[1], below[2].corner[2]};
  const double apart =
      std::sqrt(larger(largest_squared_distance(face.corner, place), largest_squared_distance(face.made, face.middle)));
  const double offset = std::sqrt(largest_squared_distance(face.made, middles_of(face.corner)));
  const auto may_matter = [&](double distance, double rest) { return matters((distance + rest) * (distance + rest)); };
  if (!may_matter(apart, share_of_rest * offset)) return;
  double most = 0;
  for (uint32_t i = 0; i < 3; ++i)
    most = larger(most, squared_move(result_.level(face.level).mesh, 3 * face.face + i, face.made[i]));
  const double rest = share_of_rest * std::sqrt(most);
  const double enough = larger(0.0, std::sqrt(limit_) - rest);
  const auto add = [&](Vec3d vertex, Vec3d at) {
    if (!may_matter(length(vertex - at), rest)) return;
    const double distance = std::sqrt(result_.squared_distance_from(leaf_, vertex, enough * enough));
    note((distance + rest) * (distance + rest));
  };
  for (uint32_t i = 0; i < 3; ++i) {
    add(face.corner[i], place[i]);
    add(face.made[i], face.middle[i]);
  }
}

/// Returns the largest sum of moves below the children of a face; 0 where none are held.
double LeafComparison::largest_sum_below(uint32_t k, FaceId f) const {
  return result_.has_children(k, f) ? std::ranges::max(std::span(&sums_[k + 1][result_.first_child(k, f)], 4)) : 0;
}

/// Returns a new vertex with its squared distance from the result; where that is at most `enough`, an upper bound which
/// is at most `enough` too. `place`: of the vertex in the result.
PointNear LeafComparison::find_near(Vec3d made, Vec3d place, double enough) {
  if (const PointNear beside = near_.beside(made, enough); beside.triangle != none) return beside;
  const double apart = squared_norm(made - place);
  return apart <= enough ? PointNear{made, apart} : near_.near(made, enough);
}

/// Returns the largest squared distance that does not matter.
double LeafComparison::enough() const {
  if (rest_ == 0) return limit_;
  const double left = larger(0.0, std::sqrt(limit_) - rest_);
  return left * left;
}

void LeafComparison::note(double squared) {
  if (!matters(squared)) return;
  if (stops_at_limit_) {
    is_far_ = true;
  } else {
    limit_ = squared;
    squared_share_ = squared / (allowed_here_ * allowed_here_);
    has_grown_ = true;
  }
}

}  // namespace papilio
