#pragma once

#include <array>
#include <span>

#include "base/ids.h"
#include "papilio/mesh.h"
#include "simd/extremes.h"

// Rules that keep new vertices from distorting flat regions (mesh/shape.h says where they hold). They are applied last,
// whatever the rule of the edge, and depend only on its two faces and the hinges round them.

namespace papilio {

/// Bound of the move of a new vertex towards the apex in a face's plane, across the edge, as a share of the face's
/// height. A face turns over if the move exceeds its height.
inline constexpr double inward_bound = 0.2;
/// Bounds of the move in any direction across the edge, as shares of the lesser height. Three new vertices that each
/// move by at most a quarter cannot turn over the face between them. Organic meshes need more room to be round.
inline constexpr double mechanical_across_bound = 0.25, organic_across_bound = 0.65;

/// Returns the share of a face's bounds that its sharpest hinge leaves, where the product of the normals is `cosine`.
/// Moves tilt faces: the sharper a hinge, the less may its faces tilt before it becomes a fold of 120 degrees. At that
/// angle nothing is left.
[[nodiscard]] inline double room_in_faces(double cosine) { return larger(0.0, 0.3 + 0.6 * cosine); }
/// Returns the share of the bound out of a face's plane that its sharpest hinge leaves on curves, where the product of
/// the normals is `cosine`. It is 1 up to 90 degrees: the rims of a drum are round.
[[nodiscard]] inline double room_on_curves(double cosine) { return lesser(larger(1 + 4 * cosine, 0.05), 1.0); }

/// Per-element values of a level that the shape rules look up.
struct ShapeField {
  Buffer<uint8_t> is_flat;        ///< [E] whether both faces lie in one plane; 0 on curves
  Buffer<double> squared_height;  ///< [F] square of the face's least height
  Buffer<float> sharpest;         ///< [F] least cosine of the face's hinges, curves included; empty in organic meshes
  Buffer<double> squared_height_at_shared{};  ///< [E] least of the faces at a shared edge that are higher than
                                              ///< `ShapeMarks::flat_distance`; empty without shared edges

  /// Returns the share of the face's bounds that is left beside smooth edges.
  [[nodiscard]] double room(FaceId f) const { return sharpest.empty() ? 1 : room_in_faces(sharpest[f]); }
};

/// Computes the field of a level whose `Topology::shape` has rules; `normals` [F] are those of its faces. O(E).
[[nodiscard]] ShapeField shape_field(const Mesh& mesh, const Buffer<Vec3f>& normals);

/// Returns whether the faces of the stencil of h, whose edge is smooth, lie in one plane: its two faces, and the faces
/// across their other sides, except across curves. The edge's midpoint is then on the surface, and keeps the angles.
[[nodiscard]] inline bool has_flat_stencil(const Topology& mesh, const ShapeField& field, HalfEdgeId h) {
  const HalfEdgeId t = mesh.twin[h];
  const auto is_flat = [&](uint32_t side) { return field.is_flat[mesh.edge[side]] != 0 || mesh.is_curve(side); };
  return field.is_flat[mesh.edge[h]] != 0 && is_flat(h.next()) && is_flat(h.previous()) && is_flat(t.next()) &&
         is_flat(t.previous());
}

/// Returns the two sides on curves of a strip's diagonal: h is a smooth edge between two curves. One is a side of its
/// left face that meets one end, the other of its right face that meets the other end. Returns `none` for other edges.
[[nodiscard]] inline std::array<uint32_t, 2> sides_of_strip(const Topology& mesh, HalfEdgeId h) {
  const HalfEdgeId t = mesh.twin[h];
  if (t == none || mesh.is_curve(h)) return {none, none};
  const bool is_next = mesh.is_curve(h.next());
  const bool is_previous = mesh.is_curve(h.previous());
  if (is_next == is_previous || mesh.is_curve(t.next()) != is_next || mesh.is_curve(t.previous()) != is_previous)
    return {none, none};
  if (is_next) return {h.next(), t.next()};
  return {h.previous(), t.previous()};
}

/// Face at an edge: its other corner, its height, and its share of the bound out of its plane.
struct FaceAtEdge {
  Vec3d apex;
  double height;
  double room = 1;
};

/// Returns the new vertex's offset `off` from the midpoint of the edge from a to b. In the planes of the edge's one or
/// two faces, it is limited to `inward_bound` of their heights towards their apexes. Then its part across the edge is
/// shortened, which keeps it in a plane that contains it:
/// - to `across_bound` of the lesser height;
/// - until its distance from each face's plane is at most `room` times `across_bound` of the face's height.
/// Bit-identical from b to a, and for any order of the faces.
[[nodiscard]] Vec3d keep_unfolded(Vec3d off, Vec3d a, Vec3d b, std::span<const FaceAtEdge> faces, double across_bound);

/// Returns the offset `off` with its part across the edge from a to b shortened to at most `most`. Bit-identical from b
/// to a.
[[nodiscard]] Vec3d shorten_across(Vec3d off, Vec3d a, Vec3d b, double most);

}  // namespace papilio
