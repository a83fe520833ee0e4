#include "hierarchy/level_surface.h"

#include <algorithm>

#include "hierarchy/patch.h"

namespace papilio {
namespace {

constexpr size_t most_faces_visited = 64, most_new_faces_visited = 8;

LevelSurface::Nearest nearest_of(const Corners& face, Vec3d point) {
  return {squared_distance(point, {face[0], face[1], face[2]}), face};
}

const LevelSurface::Nearest& nearer(const LevelSurface::Nearest& one, const LevelSurface::Nearest& other) {
  return other.squared < one.squared ? other : one;
}

}  // namespace

LevelSurface::Nearest LevelSurface::nearest(LevelFace from, uint32_t coarsest, Vec3d point, double enough) {
  auto [k, f] = from;
  Nearest found;
  for (;; --k) {
    found = nearer(found, nearest_of_level(k, f, point, enough));
    if (found.squared > enough && result_->has_children(k, f))
      found = nearer(found, nearest_where_it_slid(k, f, point, enough));
    if (found.squared <= enough || k == coarsest) return found;
    f = result_->level(k).parent_of(f);
  }
}

LevelSurface::Nearest LevelSurface::nearest_of_level(uint32_t k, FaceId f, Vec3d point, double enough) {
  if (!result_->has_children(k, f))
    if (const Nearest found = nearest_by_walk(k, f, point); found.squared <= enough) return found;
  visited_.assign(1, walk_towards(k, f, point));
  Nearest found = nearest_below(k, visited_[0], point, enough);
  for (size_t at = 0; at < visited_.size() && found.squared > enough; ++at)
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t twin = twin_in_region(k, 3 * visited_[at] + i);
      if (twin == none || visited_.size() == most_faces_visited ||
          std::ranges::count(visited_, Topology::face(twin)) > 0)
        continue;
      const Nearest across = nearest_below(k, Topology::face(twin), point, enough);
      if (across.squared > found.squared) continue;
      found = across;
      visited_.push_back(Topology::face(twin));
    }
  return found;
}

LevelSurface::Nearest LevelSurface::nearest_by_walk(uint32_t k, FaceId f, Vec3d point) const {
  std::array<Corners, 4> children = new_faces(k, f);
  uint32_t c = 3;
  for (size_t step = 0; step < most_new_faces_visited; ++step) {
    const std::array<double, 3> inside = weights_in(children[c], point);
    const auto side = static_cast<uint32_t>(std::ranges::min_element(inside) - inside.begin());
    if (inside[side] >= 0) break;
    if (c == 3) {
      c = (side + 1) % 3;
    } else if (side == inner_side[c]) {
      c = 3;
    } else {  // on the face's side of this number, near corner c
      const uint32_t twin = twin_in_region(k, 3 * f + side);
      if (twin == none || result_->has_children(k, Topology::face(twin))) break;
      f = Topology::face(twin);
      c = c == side ? (twin + 1) % 3 : twin % 3;
      children = new_faces(k, f);
    }
  }
  return nearest_of(children[c], point);
}

LevelSurface::Nearest LevelSurface::nearest_below(uint32_t k, FaceId f, Vec3d point, double enough) const {
  for (; result_->has_children(k, f); ++k) f = result_->first_child(k, f) + child_below(k, f, point);
  return nearest_new_face(k, f, point, enough);
}

LevelSurface::Nearest LevelSurface::nearest_where_it_slid(uint32_t k, FaceId f, Vec3d point, double enough) const {
  f = walk_towards(k, f, point);
  while (result_->has_children(k, f)) {
    f = result_->first_child(k, f) + child_below(k, f, point);
    ++k;
    // A neighbour that was not explored as deep is too coarse to locate the surface.
    const uint32_t beside = walk_towards(k, f, point);
    if (result_->has_children(k, beside) || !result_->has_children(k, f)) f = beside;
  }
  return nearest_new_face(k, f, point, enough);
}

LevelSurface::Nearest LevelSurface::nearest_new_face(uint32_t k, FaceId f, Vec3d point, double enough) const {
  const std::array<Corners, 4> children = new_faces(k, f);
  const uint32_t first = child_below(k, f, point);
  Nearest found = nearest_of(children[first], point);
  for (uint32_t c = 0; c < 4 && found.squared > enough; ++c)
    if (c != first) found = nearer(found, nearest_of(children[c], point));
  return found;
}

std::array<Corners, 4> LevelSurface::new_faces(uint32_t k, FaceId f) const {
  const Corners corner = result_->corners(k, f);
  return children_of(corner, result_->new_vertices(k, f, corner));
}

uint32_t LevelSurface::twin_in_region(uint32_t k, HalfEdgeId h) const {
  const Topology& mesh = result_->topology(k);
  return result_->choice(k).region.has_edge[mesh.edge[h]] != 0 ? mesh.twin[h] : none;
}

FaceId LevelSurface::walk_towards(uint32_t k, FaceId f, Vec3d point) const {
  uint32_t from = none;
  for (size_t step = 0; step < most_faces_visited; ++step) {
    const std::array<double, 3> inside = weights_in(result_->corners(k, f), point);
    const auto side = static_cast<uint32_t>(std::ranges::min_element(inside) - inside.begin());
    const uint32_t across = inside[side] < 0 ? twin_in_region(k, 3 * f + side) : none;
    if (across == none || Topology::face(across) == from) break;
    from = f;
    f = Topology::face(across);
  }
  return f;
}

std::array<double, 3> LevelSurface::weights_in(const Corners& corner, Vec3d point) {
  const Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  std::array<double, 3> inside{};
  for (uint32_t i = 0; i < 3; ++i) inside[i] = dot(cross(corner[(i + 1) % 3] - corner[i], point - corner[i]), normal);
  return inside;
}

uint32_t LevelSurface::child_below(uint32_t k, FaceId f, Vec3d point) const {
  const std::array<double, 3> inside = weights_in(result_->corners(k, f), point);
  const double half = 0.5 * (inside[0] + inside[1] + inside[2]);
  for (uint32_t i = 0; i < 3; ++i)
    if (inside[i] > half) return (i + 2) % 3;
  return 3;
}

}  // namespace papilio
