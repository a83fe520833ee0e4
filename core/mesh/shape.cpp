#include "mesh/shape.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/trigonometry.h"
#include "mesh/crease.h"
#include "mesh/curve.h"
#include "mesh/fan.h"
#include "mesh/hinge.h"
#include "mesh/smoothing_groups.h"

namespace papilio {
namespace {

constexpr double flat_degrees = 0.5, least_outline_degrees = 3, sharp_degrees = 31;
constexpr double least_flat_share = 0.25, least_flat_or_sharp_share = 0.5;
constexpr double broader = 1.5;              // by so much a flat must be broader than what it ends at
constexpr double flat_share_of_size = 2e-6;  // of the diagonal or the largest coordinate

class ShapeFinder {
 public:
  explicit ShapeFinder(Mesh& mesh)
      : mesh_(mesh),
        topology_(mesh.topology),
        components_(topology_.face_count()),
        cosines_(Buffer<double>::for_overwrite(topology_.edge_count())) {}

  ShapeReport run(const Options& options) {
    set_distance();
    find_cosines();
    find_components();
    choose_mechanical(options.shape);
    topology_.shape.has_rules = true;
    topology_.shape.is_mechanical = std::ranges::find(is_mechanical_, 1) != is_mechanical_.end();
    if (options.crease_angle < 180) {
      mark_creases(mesh_, options.crease_angle);
    } else {
      if (topology_.shape.is_mechanical) find_creases();
      marked_ = mark_group_creases(mesh_);
    }
    topology_.darts = find_darts(topology_);
    if (topology_.shape.is_mechanical) find_corners();
    return report();
  }

 private:
  void set_distance() {
    const Box box = bounding_box(mesh_.positions);
    const double size = std::max(box.diagonal(), static_cast<double>(box.largest_coordinate()));
    topology_.shape.flat_distance = flat_share_of_size * size;
  }

  [[nodiscard]] bool has_two_faces(uint32_t e) const { return topology_.kind[e] == EdgeKind::smooth; }
  [[nodiscard]] uint32_t face_of(uint32_t e) const { return Topology::face(topology_.half_edge[e]); }
  [[nodiscard]] uint32_t other_face_of(uint32_t e) const {
    return Topology::face(topology_.twin[topology_.half_edge[e]]);
  }

  void find_cosines() {
    for (uint32_t e = 0; e < topology_.edge_count(); ++e)
      if (has_two_faces(e)) {
        const Hinge hinge(topology_, mesh_.positions, topology_.half_edge[e]);
        cosines_[e] = hinge.is_flat(topology_.shape.flat_distance) ? 1 : hinge.cosine();
      }
  }

  void find_components() {
    Buffer<uint32_t> first(topology_.edge_count(), none);  // face at the edge
    for (uint32_t h = 0; h < topology_.half_edge_count(); ++h) {
      uint32_t& face = first[topology_.edge[h]];
      if (face == none)
        face = Topology::face(h);
      else
        components_.join(face, Topology::face(h));
    }
  }

  void choose_mechanical(Shape shape) {
    const uint32_t faces = topology_.face_count();
    is_mechanical_.assign(faces, shape == Shape::mechanical ? 1 : 0);
    if (shape != Shape::automatic) return;
    struct Edges {
      uint32_t all = 0, flat = 0, sharp = 0;
    };
    std::vector<Edges> of(faces);  // of the component that this face stands for
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e)) continue;
      Edges& edges = of[components_.find(face_of(e))];
      ++edges.all;
      edges.flat += is_flat(e) ? 1 : 0;
      edges.sharp += is_sharp(e) ? 1 : 0;
    }
    for (uint32_t f = 0; f < faces; ++f) {
      const Edges& edges = of[components_.find(f)];
      const bool is_flat_enough = edges.flat >= least_flat_share * edges.all;
      is_mechanical_[f] =
          edges.all > 0 && is_flat_enough && edges.flat + edges.sharp >= least_flat_or_sharp_share * edges.all ? 1 : 0;
    }
  }

  [[nodiscard]] bool is_flat(uint32_t e) const { return cosines_[e] > flat_cosine_; }
  [[nodiscard]] bool is_sharp(uint32_t e) const { return cosines_[e] < sharp_cosine_; }

  void find_creases() {
    DisjointSets flats(topology_.face_count());
    for (uint32_t e = 0; e < topology_.edge_count(); ++e)
      if (has_two_faces(e) && is_flat(e)) flats.join(face_of(e), other_face_of(e));
    const std::vector<Flat> of = measure(flats);
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (!has_two_faces(e) || is_mechanical_[face_of(e)] == 0) continue;
      const Flat& one = of[flats.find(face_of(e))];
      const Flat& other = of[flats.find(other_face_of(e))];
      if (is_sharp(e) || (cosines_[e] < outline_cosine_ && (one.is_broader(other) || other.is_broader(one))))
        topology_.kind[e] = EdgeKind::crease;
    }
  }

  struct Flat {
    uint32_t faces = 0;
    double area = 0, perimeter = 0;
    /// By area over perimeter; neither need be known to be more than nothing.
    [[nodiscard]] bool is_broader(const Flat& other) const {
      return faces >= 2 && area * other.perimeter >= broader * other.area * perimeter;
    }
  };

  std::vector<Flat> measure(DisjointSets& flats) const {
    std::vector<Flat> of(topology_.face_count());  // of the flat that this face stands for
    const auto at = [&](uint32_t h) { return to_double(mesh_.positions[topology_.origin[h]]); };
    for (uint32_t f = 0; f < topology_.face_count(); ++f) {
      Flat& flat = of[flats.find(f)];
      ++flat.faces;
      flat.area += 0.5 * length(cross(at(3 * f + 1) - at(3 * f), at(3 * f + 2) - at(3 * f)));
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const uint32_t t = topology_.twin[h];
        if (t == none || flats.find(Topology::face(t)) != flats.find(f))
          flat.perimeter += length(at(Topology::next(h)) - at(h));
      }
    }
    return of;
  }

  void find_corners() {
    const auto is_curve = [&](uint32_t e) { return topology_.kind[e] != EdgeKind::smooth; };
    const VertexDegrees curves(topology_, is_curve);
    Buffer<uint32_t> last(topology_.vertex_count, none);  // the other end of the last edge of a curve at the vertex
    for (uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (!is_curve(e)) continue;
      const uint32_t h = topology_.half_edge[e];
      last[topology_.origin[h]] = topology_.tip(h);
      last[topology_.tip(h)] = topology_.origin[h];
    }
    Buffer<uint8_t> is_mechanical(topology_.vertex_count, 0);
    for (uint32_t h = 0; h < topology_.half_edge_count(); ++h)
      is_mechanical[topology_.origin[h]] |= is_mechanical_[Topology::face(h)];
    const auto turns = [&](uint32_t v, uint32_t before, uint32_t after) {
      const auto at = [&](uint32_t vertex) { return to_double(mesh_.positions[vertex]); };
      const Vec3d u = at(v) - at(before);
      const Vec3d w = at(after) - at(v);
      return dot(u, w) < sharp_cosine_ * length(u) * length(w);
    };
    for (uint32_t v = 0; v < topology_.vertex_count; ++v) {
      if (is_mechanical[v] == 0 || curves.degree[v] == 0 || is_dart(topology_, v)) continue;
      if (curves.degree[v] != 2 || turns(v, curves.neighbours[v] ^ last[v], last[v]))
        topology_.shape.corners.push_back(v);
    }
  }

  ShapeReport report() {
    ShapeReport report;
    for (uint32_t f = 0; f < topology_.face_count(); ++f) {
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
  Buffer<double> cosines_;         ///< [E] of the angle between the two faces' normals
  Buffer<uint8_t> is_mechanical_;  ///< [F]
  uint32_t marked_ = 0;            ///< creases of smoothing groups
};

}  // namespace

ShapeReport mark_shape(Mesh& mesh, const Options& options) {
  if (mesh.detail) return {};  // which shapes the surface
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
