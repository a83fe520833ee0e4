#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "papilio/buffer.h"
#include "papilio/vec3.h"

// Half-edge mesh that every step of the core works on: flat arrays, without pointers or hash tables.
//
// Face f owns half-edges 3f, 3f+1, 3f+2. Half-edge h runs from origin(h) to origin(next(h)) with the face on its left,
// counter-clockwise seen from outside. A vertex is a position: points with equal positions are one vertex. A pinched
// vertex carries several fans of faces. Rules walk the fan of the current half-edge, and so treat each fan as a
// separate vertex.

namespace papilio {

/// Three indices into a position array, counter-clockwise seen from outside.
using Triangle = std::array<uint32_t, 3>;

/// Values of the points, such as texture coordinates, normals or colours. All but displacements are interpolated
/// linearly.
struct Attribute {
  uint32_t components = 1;
  bool unit_length = false;    ///< whether values are normalized after interpolation, as normals are
  std::vector<double> values;  ///< [points * components], point by point
  /// Whether the values are smoothing groups of faces, one at each point of a face. Edges between faces of different
  /// groups are creases (core/mesh/smoothing_groups.h).
  bool is_smoothing_group = false;
  /// Whether the values, of 3 components, displace the points, as morph targets do. Displacements are refined by the
  /// rules of positions, so that the refined surface moves as the coarse mesh does. They are interpolated linearly
  /// where points of one vertex move apart, and next to such vertices.
  bool is_displacement = false;

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// Triangles as in files and streams: input and output of the core. Positions may be repeated or unused, and faces may
/// be degenerate. Points with equal positions and different attributes form a seam.
struct TriangleMesh {
  Buffer<Vec3f> positions;  ///< [points]
  Buffer<Triangle> triangles;
  std::vector<Attribute> attributes{};

  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

inline constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

/// Kind of an edge in the subdivision rules. All but `smooth` are curves: rings end there, and the edge is split by the
/// rule along the curve.
enum class EdgeKind : uint8_t {
  smooth,    ///< two faces with consistent orientation
  boundary,  ///< one face
  shared,    ///< three faces or more, or two with opposite orientation: a boundary of each of its faces
  crease,    ///< two faces, kept sharp
  cut,       ///< border of the faces that a level of the hierarchy holds: faces of the uniform mesh are missing beyond
};

/// Shapes found on the coarse mesh (mesh/shape.h). Every level inherits them.
struct ShapeMarks {
  bool has_rules = false;      ///< whether new vertices follow the shape rules (rules/shape_rules.h)
  bool is_mechanical = false;  ///< whether any component is mechanical
  double flat_distance = 0;    ///< largest distance of a point that lies in a face's plane, in the mesh's unit
  /// Vertices of mechanical components at which curves end, in ascending order: corners of a curve, and vertices at
  /// which other than two curve edges meet.
  std::vector<uint32_t> corners;
};

/// Connectivity of F faces, H = 3F half-edges, E edges and V vertices. Edges are optional: without them `edge`,
/// `half_edge` and `kind` are empty.
struct Topology {
  uint32_t vertex_count = 0;
  Buffer<uint32_t> origin;     ///< [H] vertex that the half-edge leaves
  Buffer<uint32_t> twin;       ///< [H] opposite half-edge; `none` at boundary and shared edges
  Buffer<uint32_t> edge;       ///< [H] edge that the half-edge runs along, in either direction
  Buffer<uint32_t> half_edge;  ///< [E] one half-edge of each edge
  Buffer<EdgeKind> kind;       ///< [E]
  /// Vertices of the coarse mesh with several fans, in ascending order. New vertices on shared edges have several too,
  /// but are not listed: rules find them by their curves.
  std::vector<uint32_t> pinched;
  /// Interior vertices at which a single crease ends, in ascending order. Rules treat them as vertices without a
  /// crease.
  std::vector<uint32_t> darts;
  ShapeMarks shape;

  [[nodiscard]] bool has_edges() const { return edge.size() == origin.size(); }
  [[nodiscard]] uint32_t face_count() const { return static_cast<uint32_t>(origin.size() / 3); }
  [[nodiscard]] uint32_t edge_count() const { return static_cast<uint32_t>(half_edge.size()); }
  [[nodiscard]] uint32_t half_edge_count() const { return static_cast<uint32_t>(origin.size()); }

  static uint32_t face(uint32_t h) { return h / 3; }
  static uint32_t next(uint32_t h) { return h + 1 - (h % 3 == 2 ? 3U : 0U); }
  static uint32_t previous(uint32_t h) { return h - 1 + (h % 3 == 0 ? 3U : 0U); }
  [[nodiscard]] uint32_t tip(uint32_t h) const { return origin[next(h)]; }
  /// Returns the vertex of h's face that h does not touch.
  [[nodiscard]] uint32_t apex(uint32_t h) const { return origin[previous(h)]; }
  [[nodiscard]] bool is_curve(uint32_t h) const { return kind[edge[h]] != EdgeKind::smooth; }
  /// Returns V - E + F.
  [[nodiscard]] int64_t euler_characteristic() const {
    return int64_t{vertex_count} - int64_t{edge_count()} + int64_t{face_count()};
  }
};

/// Attributes of a mesh. A point is a vertex with its values. A vertex on a seam has several points, but one position.
struct PointAttributes {
  Buffer<uint32_t> point;             ///< [H] point at the half-edge's origin, in its face; empty without attributes
  uint32_t point_count = 0;           ///< P
  std::vector<Attribute> attributes;  ///< values [P * components] each

  [[nodiscard]] bool empty() const { return attributes.empty(); }
};

class Detail;

/// Mesh: connectivity, one position a vertex, and attributes if it has any.
struct Mesh {
  Topology topology;
  Buffer<Vec3f> positions;  ///< [V]
  PointAttributes attributes{};
  /// Source of the new vertices of refine()'s first levels, in place of the rules (papilio/detail.h). Null: the rules
  /// compute all vertices. Results of refine() have none.
  std::shared_ptr<const Detail> detail{};

  /// Sets `detail` and marks the curves of its base. Throws `Error` bad_surface unless the mesh is that base
  /// (`Detail::fits`).
  void attach_detail(std::shared_ptr<const Detail> given);

  /// Returns faces and positions: of points if the mesh has attributes, else of vertices.
  [[nodiscard]] TriangleMesh triangles() const&;
  /// Returns faces and positions, and moves the positions out where possible.
  [[nodiscard]] TriangleMesh triangles() &&;
};

/// Defects that build_mesh() found and removed.
struct BuildReport {
  uint32_t welded_points = 0;     ///< points dropped because an earlier one has the same position
  uint32_t isolated_points = 0;   ///< dropped points that no face uses
  uint32_t degenerate_faces = 0;  ///< dropped faces with two equal positions
  uint32_t repeated_faces = 0;    ///< dropped faces with the vertices and orientation of an earlier one
  uint32_t boundary_edges = 0;
  uint32_t non_manifold_edges = 0;  ///< edges with three faces or more
  uint32_t misoriented_edges = 0;   ///< edges whose two faces run along them in the same direction
  uint32_t pinched_vertices = 0;    ///< vertices at which several fans of faces touch
  uint32_t near_duplicates = 0;     ///< boundary vertices welded to another within the gap
  uint32_t t_junctions = 0;         ///< boundary vertices inserted in boundary edges on which they lay
};

/// Upper bound of the magnitude of a coordinate, so that no later sum or square overflows.
inline constexpr float coordinate_limit = 1e18F;

/// Upper bound of the faces of any level: half-edges have 32-bit numbers.
inline constexpr uint64_t face_count_limit = 1ULL << 30;

/// Builds the mesh: welds points of equal position (bit-identical, or -0 and 0) and drops points and faces that cannot
/// be refined. Vertices are numbered in the order in which the faces first use them; face order is kept. O(n log n) at
/// worst. Throws `Error`: index_out_of_range, not_finite (NaN, infinite or beyond `coordinate_limit`), no_faces,
/// out_of_memory.
///
/// `gap`, a share of the bounding box's diagonal, closes gaps that rounding left open (core/mesh/close_gaps.h):
/// boundary vertices are welded, and vertices of T-junctions divide faces. 0 closes nothing. A mesh without such gaps
/// is built bit-identically for every `gap`.
[[nodiscard]] Mesh build_mesh(const TriangleMesh& input, BuildReport* report = nullptr, double gap = 0);

/// Gap that rounding to floats may cause, and that is too narrow to be intended.
inline constexpr double rounding_gap = 1e-6;

/// Axis-parallel box. Without points, `min` is above `max`.
struct Box {
  Vec3f min, max;
  [[nodiscard]] double diagonal() const;
  [[nodiscard]] Vec3d centre() const;
  /// Returns the largest magnitude of a coordinate; 0 without points.
  [[nodiscard]] float largest_coordinate() const;
};
[[nodiscard]] Box bounding_box(std::span<const Vec3f> positions);

/// Returns [V] the unit normal of each vertex: the area-weighted mean of its faces' normals; (0, 0, 1) where they
/// cancel out or there are none.
[[nodiscard]] Buffer<Vec3f> vertex_normals(const Mesh& mesh);

/// Recomputes a mesh's own normals, the attribute `number` of 3 components, from its current surface. Points of one
/// vertex whose normals were equal, within a degree, have equal normals again; others remain distinct. So smooth edges
/// stay smooth, and hard edges hard. New normals lie on the side of most old ones. Where the faces' normals cancel out,
/// the old normal is kept. O(P log P).
void renew_normals(Mesh& mesh, size_t number);
/// Adds normals as the last attribute: one a vertex, or on curves one for each side. Splits points where necessary. The
/// mesh must have edges. O(H log H).
void add_normals(Mesh& mesh);

}  // namespace papilio
