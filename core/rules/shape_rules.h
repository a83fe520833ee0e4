#pragma once

#include <array>
#include <span>

#include "papilio/mesh.h"

// Rules that keep new vertices from harming what is flat (mesh/shape.h says where they hold). They come last, whatever
// rule the edge had, and look at nothing but its two faces and the hinges round them.

namespace papilio {

/// A face turns over when a new vertex moves inside its plane, across the edge, by more than its height: by so much of
/// it one may.
inline constexpr double inward_bound = 0.2;
/// In any direction across the edge, of the lesser height. Three new vertices that each keep to a quarter cannot turn
/// over what lies between them; an organic mesh needs more room to be round.
inline constexpr double mechanical_across_bound = 0.25, organic_across_bound = 0.65;

/// What the shape rules need to know of a level.
struct ShapeField {
  Buffer<uint8_t> is_flat;        ///< [E] both faces lie in one plane; not of curves
  Buffer<double> squared_height;  ///< [F] of the least height of the face
};

/// Of a level whose `Topology::shape` has rules; `normals` [F] are its faces'. O(E).
[[nodiscard]] ShapeField shape_field(const Mesh& mesh, const Buffer<Vec3f>& normals);

/// Whether the faces of the stencil of h, whose edge is smooth, lie in one plane: its two faces and those across their
/// other sides, as far as there is no curve between. The edge's midpoint is on the surface then, and keeps the angles.
[[nodiscard]] inline bool has_flat_stencil(const Topology& mesh, const ShapeField& field, uint32_t h) {
  const uint32_t t = mesh.twin[h];
  const auto is_flat = [&](uint32_t side) { return field.is_flat[mesh.edge[side]] != 0 || mesh.is_curve(side); };
  return field.is_flat[mesh.edge[h]] != 0 && is_flat(Topology::next(h)) && is_flat(Topology::previous(h)) &&
         is_flat(Topology::next(t)) && is_flat(Topology::previous(t));
}

/// The two sides on curves of a strip's diagonal: where h is a smooth edge between two curves, one a side of its left
/// face that meets one end, the other of its right face that meets the other end. `none` of all others.
[[nodiscard]] inline std::array<uint32_t, 2> sides_of_strip(const Topology& mesh, uint32_t h) {
  const uint32_t t = mesh.twin[h];
  if (t == none || mesh.is_curve(h)) return {none, none};
  const bool is_next = mesh.is_curve(Topology::next(h));
  const bool is_previous = mesh.is_curve(Topology::previous(h));
  if (is_next == is_previous || mesh.is_curve(Topology::next(t)) != is_next ||
      mesh.is_curve(Topology::previous(t)) != is_previous)
    return {none, none};
  if (is_next) return {Topology::next(h), Topology::next(t)};
  return {Topology::previous(h), Topology::previous(t)};
}

/// A face at an edge: its other corner, and its height.
struct FaceAtEdge {
  Vec3d apex;
  double height;
};

/// How far the new vertex of the edge from a to b may be off its midpoint, where it wants to be `off`: inside the
/// planes of the edge's one or two faces no further than `inward_bound` of their heights towards their apexes, and
/// across the edge no further than `across_bound` of the lesser height. The same to the bit from b to a, and in
/// whatever order the faces come.
[[nodiscard]] Vec3d keep_unfolded(Vec3d off, Vec3d a, Vec3d b, std::span<const FaceAtEdge> faces, double across_bound);

}  // namespace papilio
