#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "papilio/buffer.h"
#include "papilio/vec3.h"

// The half-edge mesh that every step of the core works on: flat arrays, no pointers, no hash once it is
// built.
//
// Face f owns half-edges 3f, 3f+1, 3f+2; half-edge h runs from origin(h) to origin(next(h)) with the face on
// its left (counter-clockwise seen from outside). Vertices are positions: points that share one are one
// vertex. A vertex may carry several fans of faces (a pinched vertex); rules that look at a vertex's ring
// walk the fan of the half-edge at hand, so each fan is a vertex of its own to them.

namespace papilio {

/// Three indices into a position array, counter-clockwise seen from outside.
using Triangle = std::array<uint32_t, 3>;

/// Values that go with the points: texture coordinates, normals, colours, anything. They are interpolated linearly,
/// but for displacements.
struct Attribute {
  uint32_t components = 1;
  bool unit_length = false;    ///< brought back to length one after interpolation: normals
  std::vector<double> values;  ///< [points * components], point by point
  /// Number of a face's smoothing group, at each of its points: edges between faces of different groups, or of group 0,
  /// are creases (core/mesh/smoothing_groups.h).
  bool is_smoothing_group = false;
  /// With 3 components: moves the points, as a morph target does. It is split by the rules of the positions, so that it
  /// moves the refined surface as it moves the coarse mesh; by linear interpolation where points of one vertex move
  /// apart, and round them.
  bool is_displacement = false;

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// Triangles as files and streams carry them: what goes into the core and what comes out. Nothing is promised
/// of it: there may be repeated positions, unused ones, degenerate faces. Points that share a position but not their
/// attributes are a seam.
struct TriangleMesh {
  Buffer<Vec3f> positions;  ///< [points]
  Buffer<Triangle> triangles;
  std::vector<Attribute> attributes{};

  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

inline constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

/// What an edge is to the subdivision rules. All but `smooth` are curves: rings end there, and the edge
/// itself is split by the rule along the curve.
enum class EdgeKind : uint8_t {
  smooth,    ///< two faces, wound alike
  boundary,  ///< one face
  shared,    ///< three faces or more, or two wound against each other: a boundary of every face at it
  crease,    ///< two faces, kept sharp
  cut,       ///< faces of the uniform mesh are missing here: the border of what a red-green level holds (hierarchy.h)
};

/// What the shape rules found on the coarse mesh (mesh/shape.h). Every level inherits it.
struct ShapeMarks {
  bool has_rules = false;      ///< whether new vertices follow the shape rules (rules/shape_rules.h)
  bool is_mechanical = false;  ///< whether any component is
  double flat_distance = 0;    ///< a point this close to a face's plane lies in it; in the mesh's unit
  /// Vertices of mechanical components at which curves end, in ascending order: corners of a curve, and where other
  /// than two curve edges meet.
  std::vector<uint32_t> corners;
};

/// Connectivity. Shapes: F faces, H = 3F half-edges, E edges, V vertices. Edges may be left out: then `edge`,
/// `half_edge` and `kind` are empty.
struct Topology {
  uint32_t vertex_count = 0;
  Buffer<uint32_t> origin;     ///< [H] vertex that the half-edge leaves
  Buffer<uint32_t> twin;       ///< [H] the half-edge running the other way, `none` at boundary and shared edges
  Buffer<uint32_t> edge;       ///< [H] edge of the half-edge, the same for all that run along it
  Buffer<uint32_t> half_edge;  ///< [E] one half-edge of each edge
  Buffer<EdgeKind> kind;       ///< [E]
  /// Vertices of the coarse mesh with more than one fan, in ascending order. (Vertices that arise on shared edges have
  /// several too; rules find those by their curves.)
  std::vector<uint32_t> pinched;
  /// Vertices inside the surface at which a single crease ends, in ascending order. To the rules they are vertices
  /// without a crease.
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
  /// The vertex of h's face that h does not touch.
  [[nodiscard]] uint32_t apex(uint32_t h) const { return origin[previous(h)]; }
  [[nodiscard]] bool is_curve(uint32_t h) const { return kind[edge[h]] != EdgeKind::smooth; }
  /// Vertices less edges plus faces.
  [[nodiscard]] int64_t euler_characteristic() const {
    return int64_t{vertex_count} - int64_t{edge_count()} + int64_t{face_count()};
  }
};

/// Attributes of a mesh. A point is a vertex together with its values; where charts meet, one vertex is several points,
/// and positions do not open.
struct PointAttributes {
  Buffer<uint32_t> point;             ///< [H] point at the origin of the half-edge, in its face; empty: no attributes
  uint32_t point_count = 0;           ///< P
  std::vector<Attribute> attributes;  ///< values [P * components] each

  [[nodiscard]] bool empty() const { return attributes.empty(); }
};

class Detail;

/// A mesh: connectivity and one position a vertex, and attributes if it has any.
struct Mesh {
  Topology topology;
  Buffer<Vec3f> positions;  ///< [V]
  PointAttributes attributes{};
  /// Gives the new vertices of the first levels that refine() makes, in place of the rules (papilio/detail.h); null
  /// where the rules give all. Results of refine() have none.
  std::shared_ptr<const Detail> detail{};

  /// Sets `detail`, and marks the curves of its base. Throws `Error` bad_surface unless the mesh is its base
  /// (`Detail::fits`).
  void attach_detail(std::shared_ptr<const Detail> given);

  /// Copies the faces and positions out; with attributes, points in place of vertices. Of a mesh that is not needed any
  /// more positions need no copy.
  [[nodiscard]] TriangleMesh triangles() const&;
  [[nodiscard]] TriangleMesh triangles() &&;
};

/// What was found in the triangles, and what was done about it.
struct BuildReport {
  uint32_t welded_points = 0;     ///< points dropped because an earlier one has the same position
  uint32_t isolated_points = 0;   ///< positions that no face uses, dropped
  uint32_t degenerate_faces = 0;  ///< faces with two equal positions, dropped
  uint32_t repeated_faces = 0;    ///< faces with the vertices and orientation of an earlier one, dropped
  uint32_t boundary_edges = 0;
  uint32_t non_manifold_edges = 0;  ///< edges with three faces or more
  uint32_t misoriented_edges = 0;   ///< edges whose two faces run along them in the same direction
  uint32_t pinched_vertices = 0;    ///< vertices at which several fans of faces touch
  uint32_t near_duplicates = 0;     ///< boundary vertices dropped because another within the gap takes their place
  uint32_t t_junctions = 0;         ///< boundary vertices inserted in the boundary edges that they lay on
};

/// Largest magnitude of a coordinate, so that no later sum or square overflows.
inline constexpr float coordinate_limit = 1e18F;

/// Most faces that any level may have: half-edges are counted in 32 bits.
inline constexpr uint64_t face_count_limit = 1ULL << 30;

/// Builds the mesh: welds points of equal position (to the bit, but -0 = 0), numbers vertices in the order in
/// which the faces name them, drops what cannot be refined and counts it. Face order is kept. O(n log n) at
/// worst. Throws `Error`: index_out_of_range, not_finite (NaN, infinite or beyond `coordinate_limit`),
/// no_faces, out_of_memory.
///
/// `gap`, a share of the bounding box's diagonal, closes what rounding leaves open (core/mesh/close_gaps.h): boundary
/// vertices are welded, those of T-junctions divide faces. 0 closes nothing. A mesh without such gaps is built to the
/// bit as with 0.
[[nodiscard]] Mesh build_mesh(const TriangleMesh& input, BuildReport* report = nullptr, double gap = 0);

/// Gap that rounding to floats explains and no design needs.
inline constexpr double rounding_gap = 1e-6;

/// An axis-parallel box. Of no points: `min` above `max`.
struct Box {
  Vec3f min, max;
  [[nodiscard]] double diagonal() const;
  [[nodiscard]] Vec3d centre() const;
  /// The largest magnitude of any; 0 of no points.
  [[nodiscard]] float largest_coordinate() const;
};
[[nodiscard]] Box bounding_box(std::span<const Vec3f> positions);

/// Unit normal of each vertex [V]: its faces' normals weighted by area; (0, 0, 1) where they cancel out or
/// there are none.
[[nodiscard]] Buffer<Vec3f> vertex_normals(const Mesh& mesh);

/// Replaces a mesh's own normals, the attribute of this number with 3 components, by those of its surface as it is now.
/// Points of one vertex that had one normal, to a degree, have one again, others are apart as before: what was smooth
/// stays smooth, what was hard stays hard. On the side that most of the old ones were on; where the faces' normals
/// cancel out the old one stays. O(P log P).
void renew_normals(Mesh& mesh, size_t number);
/// Adds normals as the last attribute, one a vertex, but where curves meet it one for each side. The mesh must have its
/// edges. Points are divided where they must be. O(H log H).
void add_normals(Mesh& mesh);

}  // namespace papilio
