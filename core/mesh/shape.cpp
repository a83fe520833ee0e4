#include "mesh/shape.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/trigonometry.h"
#include "mesh/crease.h"
#include "mesh/curve.h"
#include "mesh/fan.h"
#include "mesh/grid_step.h"
#include "mesh/hinge.h"
#include "mesh/normals.h"
#include "mesh/smoothing_groups.h"

namespace papilio {
namespace {

constexpr double flat_degrees = 0.5, least_outline_degrees = 3, sharp_degrees = 31;
constexpr double least_flat_share = 0.25, least_flat_or_sharp_share = 0.5;  // shares of the edges
constexpr double least_sharp_share = 0.1, least_share_of_flats = 0.25;      // shares of the edges, and of the area
constexpr uint32_t least_faces_of_flat = 4;                                 // quads, common in any model, have two
constexpr double lid_degrees = 7, least_sharp_share_of_lid = 0.9;           // of angles inside; of the outline's length
constexpr uint32_t least_sides_of_lid = 12;  // sharp ones; patches of coarse organic meshes have fewer
constexpr double broader = 1.5;              // factor by which a flat must be broader than its neighbour
constexpr double flat_share_of_size = 2e-6;  // share of the diagonal or the largest coordinate
// Of a grid: how far rounding may move an apex from the plane of the other face, and how far it mostly does.
constexpr double most_flat_steps = 1.5, usual_flat_steps = 0.75;
constexpr double telling_height =
    30;  // of a face whose angle the former distance changes by 2 degrees, in that distance

/// Set of faces connected by nearly flat edges.
struct FlatRegion {
  uint32_t faces = 0;
  double area = 0, outline = 0;  // outline: its length
  uint32_t sharp_sides = 0;      // of the outline
  double length_of_sharp_sides = 0;

  /// Compares ratios of area to outline, as products: all of these may be 0.
  [[nodiscard]] bool is_broader(const FlatRegion& other) const {
    return faces >= 2 && area * other.outline >= broader * other.area * outline;
  }
  [[nodiscard]] bool is_lid() const {
    return sharp_sides >= least_sides_of_lid && length_of_sharp_sides >= least_sharp_share_of_lid * outline;
  }
};

class ShapeFinder {
 public:
  explicit ShapeFinder(Mesh& mesh)
      : mesh_(mesh),
        topology_(mesh.topology),
        components_(topology_.face_count()),
        cosines_(Buffer<double>::for_overwrite(topology_.edge_count())),
        is_hidden_(topology_.edge_count(), 0) {}

  ShapeReport run(const Options& options) {
    set_distances();
    find_cosines(topology_.shape.flat_distance);
    if (step_ > 0) find_hidden();
    find_components();
    choose_mechanical(options.shape);
    topology_.shape.has_rules = true;
    topology_.shape.is_mechanical = std::ranges::find(is_mechanical_, 1) != is_mechanical_.end();
    has_corners_ = is_mechanical_;
    if (topology_.shape.is_mechanical && step_ > 0) allow_for_grid();
    if (options.crease_angle < 180) {
      mark_creases(mesh_, options.crease_angle);
    } else {
      if (topology_.shape.is_mechanical) find_creases();
      if (options.shape == Shape::automatic) find_lids();
      marked_ = mark_group_creases(mesh_);
    }
    topology_.darts = find_darts(topology_);
    if (std::ranges::find(has_corners_, 1) != has_corners_.end()) find_corners();
    return report();
  }

 private:
  void set_distances() {
    const Box box = bounding_box(mesh_.positions);
    const double size = std::max(box.diagonal(), static_cast<double>(box.largest_coordinate()));
    topology_.shape.flat_distance = flat_share_of_size * size;
    step_ = grid_step(mesh_.positions);
  }

  [[nodiscard]] bool has_two_faces(EdgeId e) const { return topology_.kind[e] == EdgeKind::smooth; }
  [[nodiscard]] uint32_t face_of(EdgeId e) const { return Topology::face(topology_.half_edge[e]); }
  [[nodiscard]] uint32_t other_face_of(EdgeId e) const {
    return Topology::face(topology_.twin[topology_.half_edge[e]]);
  }

  [[nodiscard]] Hinge hinge_at(EdgeId e) const { return {topology_, mesh_.positions, topology_.half_edge[e]}; }

  void find_cosines(double flat_distance) {
    for (EdgeId e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e)) continue;
      const Hinge hinge = hinge_at(e);
      cosines_[e] = hinge.is_flat(flat_distance) ? 1 : hinge.cosine();
    }
  }

  /// Finds the edges whose angle the grid hides, and flattens those of faces so high that they must be nearly flat.
  void find_hidden() {
    const double distance = most_flat_steps * step_;
    for (EdgeId e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e) || is_flat(e)) continue;
      const Hinge hinge = hinge_at(e);
      if (!hinge.is_flat(distance)) continue;
      if (hinge.lesser_height() >= telling_height * distance)
        cosines_[e] = 1;
      else
        is_hidden_[e] = 1;
    }
  }

  /// Flattens what the grid has bent in a mechanical mesh.
  void allow_for_grid() {
    double& flat_distance = topology_.shape.flat_distance;
    find_cosines(std::max(flat_distance, usual_flat_steps * step_));
    flat_distance = std::max(flat_distance, most_flat_steps * step_);
  }

  void find_components() {
    Buffer<uint32_t> first(topology_.edge_count(), none);  // first face at the edge
    for (HalfEdgeId h = 0; h < topology_.half_edge_count(); ++h) {
      uint32_t& face = first[topology_.edge[h]];
      if (face == none)
        face = h.face();
      else
        components_.join(face, h.face());
    }
  }

  void choose_mechanical(Shape shape) {
    const uint32_t faces = topology_.face_count();
    is_mechanical_.assign(faces, shape == Shape::mechanical ? 1 : 0);
    if (shape != Shape::automatic) return;
    struct Component {
      uint32_t edges = 0, flat = 0, sharp = 0, hidden = 0;
      double area = 0, area_of_flats = 0;
      [[nodiscard]] bool is_mechanical() const {
        if (hidden > edges) return false;
        return (flat >= least_flat_share * edges && flat + sharp >= least_flat_or_sharp_share * edges && edges > 0) ||
               (flat > 0 && flat + sharp == edges) ||
               (is_sharp_enough() && area_of_flats >= least_share_of_flats * area && area > 0);
      }
      [[nodiscard]] bool is_sharp_enough() const { return sharp > 0 && sharp >= least_sharp_share * edges; }
    };
    std::vector<Component> of(faces);  // component that this face represents
    for (EdgeId e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e)) continue;
      Component& component = of[components_.find(face_of(e))];
      if (is_hidden_[e] != 0) {
        ++component.hidden;
        continue;
      }
      ++component.edges;
      component.flat += is_flat(e) ? 1 : 0;
      component.sharp += is_sharp(e) ? 1 : 0;
    }
    if (std::ranges::any_of(of, &Component::is_sharp_enough)) {
      Regions flats = find_regions(flat_cosine_);
      for (FaceId f = 0; f < faces; ++f) {
        const double area = area_of(f);
        Component& component = of[components_.find(f)];
        component.area += area;
        if (flats.of(f).faces >= least_faces_of_flat) component.area_of_flats += area;
      }
    }
    for (uint32_t f = 0; f < faces; ++f) is_mechanical_[f] = of[components_.find(f)].is_mechanical() ? 1 : 0;
  }

  [[nodiscard]] bool is_flat(EdgeId e) const { return cosines_[e] > flat_cosine_; }
  [[nodiscard]] bool is_sharp(EdgeId e) const { return cosines_[e] < sharp_cosine_; }
  [[nodiscard]] bool is_surely_sharp(EdgeId e) const { return has_two_faces(e) && is_sharp(e) && is_hidden_[e] == 0; }

  void find_creases() {
    Regions flats = find_regions(flat_cosine_);
    for (EdgeId e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e) || is_mechanical_[face_of(e)] == 0) continue;
      const FlatRegion& one = flats.of(face_of(e));
      const FlatRegion& other = flats.of(other_face_of(e));
      if (is_sharp(e) || (cosines_[e] < outline_cosine_ && (one.is_broader(other) || other.is_broader(one))))
        topology_.kind[e] = EdgeKind::crease;
    }
  }

  /// Regions, found by any of their faces.
  struct Regions {
    DisjointSets faces;
    std::vector<FlatRegion> region;  ///< [F] region that this face represents

    [[nodiscard]] const FlatRegion& of(FaceId f) { return region[faces.find(f)]; }
    [[nodiscard]] bool is_outline(const Topology& mesh, HalfEdgeId h) {
      const HalfEdgeId t = mesh.twin[h];
      return t == none || faces.find(t.face()) != faces.find(h.face());
    }
  };

  [[nodiscard]] Vec3d origin_of(HalfEdgeId h) const { return to_double(mesh_.positions[topology_.origin[h]]); }

  [[nodiscard]] double area_of(FaceId f) const { return 0.5 * length(area_normal(mesh_, f)); }

  /// Finds and measures the regions that edges of a larger cosine join.
  [[nodiscard]] Regions find_regions(double least_cosine) {
    Regions regions{DisjointSets(topology_.face_count()), std::vector<FlatRegion>(topology_.face_count())};
    for (EdgeId e = 0; e < topology_.edge_count(); ++e)
      if (has_two_faces(e) && cosines_[e] > least_cosine) regions.faces.join(face_of(e), other_face_of(e));
    for (FaceId f = 0; f < topology_.face_count(); ++f) {
      FlatRegion& region = regions.region[regions.faces.find(f)];
      ++region.faces;
      region.area += area_of(f);
      for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) {
        if (!regions.is_outline(topology_, h)) continue;
        const double side = length(origin_of(h.next()) - origin_of(h));
        region.outline += side;
        if (!is_surely_sharp(topology_.edge[h])) continue;
        ++region.sharp_sides;
        region.length_of_sharp_sides += side;
      }
    }
    return regions;
  }

  /// Makes the sharp outlines of lids creases.
  void find_lids() {
    Regions regions = find_regions(cosine_of_degrees(lid_degrees));
    for (FaceId f = 0; f < topology_.face_count(); ++f) {
      if (is_mechanical_[f] != 0 || !regions.of(f).is_lid()) continue;
      has_corners_[f] = 1;
      for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h)
        if (regions.is_outline(topology_, h) && is_surely_sharp(topology_.edge[h]))
          topology_.kind[topology_.edge[h]] = EdgeKind::crease;
    }
  }

  void find_corners() {
    const auto is_curve = [&](EdgeId e) { return topology_.kind[e] != EdgeKind::smooth; };
    const VertexDegrees curves(topology_, is_curve);
    Buffer<uint32_t> last(topology_.vertex_count, none);  // other end of the last curve edge at the vertex
    for (EdgeId e = 0; e < topology_.edge_count(); ++e) {
      if (!is_curve(e)) continue;
      const HalfEdgeId h = topology_.half_edge[e];
      last[topology_.origin[h]] = topology_.tip(h);
      last[topology_.tip(h)] = topology_.origin[h];
    }
    Buffer<uint8_t> may_be_corner(topology_.vertex_count, 0);
    for (HalfEdgeId h = 0; h < topology_.half_edge_count(); ++h)
      may_be_corner[topology_.origin[h]] |= has_corners_[h.face()];
    const auto turns = [&](VertexId v, uint32_t before, uint32_t after) {
      const auto at = [&](VertexId vertex) { return to_double(mesh_.positions[vertex]); };
      const Vec3d u = at(v) - at(before);
      const Vec3d w = at(after) - at(v);
      return dot(u, w) < sharp_cosine_ * length(u) * length(w);
    };
    for (VertexId v = 0; v < topology_.vertex_count; ++v) {
      if (may_be_corner[v] == 0 || curves.degree[v] == 0 || is_dart(topology_, v)) continue;
      if (curves.degree[v] != 2 || turns(v, curves.neighbours[v] ^ last[v], last[v]))
        topology_.shape.corners.push_back(v);
    }
  }

  ShapeReport report() {
    ShapeReport report;
    for (FaceId f = 0; f < topology_.face_count(); ++f) {
      if (components_.find(f) != f) continue;
      ++report.components;
      report.mechanical += is_mechanical_[f];
    }
    report.marked = marked_;
    report.creases = static_cast<uint32_t>(std::ranges::count(topology_.kind, EdgeKind::crease));
    return report;
  }

  const double flat_cosine_ = cosine_of_degrees(flat_degrees);
  const double outline_cosine_ = cosine_of_degrees(least_outline_degrees);
  const double sharp_cosine_ = cosine_of_degrees(sharp_degrees);
  Mesh& mesh_;
  Topology& topology_;
  DisjointSets components_;
  Buffer<double> cosines_;         ///< [E] cosine of the angle between the two faces' normals
  Buffer<uint8_t> is_hidden_;      ///< [E] whether a grid hides the angle: it may be flat, or not
  double step_ = 0;                ///< of the positions' grid; 0 without one
  Buffer<uint8_t> is_mechanical_;  ///< [F]
  Buffer<uint8_t> has_corners_;  ///< [F] whether curves may have corners at the face: in mechanical components and lids
  uint32_t marked_ = 0;          ///< creases of smoothing groups
};

}  // namespace

ShapeReport mark_shape(Mesh& mesh, const Options& options) {
  if (mesh.detail) return {};  // the detail shapes the surface
  if (options.shape != Shape::plain && options.tension != Tension::off) return ShapeFinder(mesh).run(options);
  if (options.crease_angle < 180) {
    mark_creases(mesh, options.crease_angle);
    return {};
  }
  const uint32_t marked = mark_group_creases(mesh);
  if (marked > 0) mesh.topology.darts = find_darts(mesh.topology);
  return {.marked = marked};
}

}  // namespace papilio
