#include "detail/base_lift.h"

#include <map>
#include <utility>

#include "detail/base_points.h"
#include "detail/detail_level.h"
#include "detail/seams.h"
#include "detail/surface_tree.h"
#include "mesh/crease.h"
#include "mesh/curve.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Returns, for each of `points`, the number of the nearest of `among`.
std::vector<uint32_t> nearest_points(const Buffer<Vec3f>& points, const Buffer<Vec3f>& among) {
  TriangleMesh each{.positions = among, .triangles = {}};  // a face for each point
  for (uint32_t i = 0; i < among.size(); ++i) each.triangles.push_back({i, i, i});
  const SurfaceTree tree(std::move(each));
  std::vector<uint32_t> found;
  for (const Vec3f p : points) found.push_back(tree.nearest(to_double(p)).face);
  return found;
}

std::vector<FaceMatch> match_faces(const Mesh& mesh, const std::vector<uint32_t>& number, const BaseMesh& base) {
  std::map<Triangle, FaceMatch> by_corners;
  for (uint32_t f = 0; f < base.face.size(); ++f) {
    const Triangle& t = base.triangles.triangles[f];
    for (uint32_t i = 0; i < 3; ++i) by_corners[{t[i], t[(i + 1) % 3], t[(i + 2) % 3]}] = {base.face[f], i};
  }
  std::vector<FaceMatch> matches;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); h += 3) {
    const uint32_t* v = &mesh.topology.origin[h];
    const auto found = by_corners.find({number[v[0]], number[v[1]], number[v[2]]});
    if (found == by_corners.end() || mesh.topology.face_count() != base.face.size())
      throw Error(Fault::bad_surface, "The coder of the base moved vertices onto others.");
    matches.push_back(found->second);
  }
  return matches;
}

/// Marks the creases and corners of the sequence's base.
void mark_curves(Topology& topology, const std::vector<uint32_t>& number, const std::vector<FaceMatch>& matches,
                 const BaseMesh& base) {
  std::vector<uint32_t> place_of(base.face.empty() ? 0 : base.face.back() + 1, none);  // face of the base
  for (uint32_t f = 0; f < base.face.size(); ++f) place_of[base.face[f]] = f;
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    const FaceMatch& match = matches[h / 3];
    if (base.is_crease[place_of[match.face]][(h + match.turn) % 3]) topology.kind[topology.edge[h]] = EdgeKind::crease;
  }
  topology.darts = find_darts(topology);
  const VertexDegrees curves(topology, [&](uint32_t e) { return topology.kind[e] != EdgeKind::smooth; });
  for (uint32_t v = 0; v < number.size(); ++v)
    if (curves.degree[v] == 2 && base.is_corner[number[v]]) topology.shape.corners.push_back(v);
}

}  // namespace

LiftedBase lift_base(const CollapseSequence& sequence, const BaseMesh& base, const CodedBase& coded,
                     const OriginalSurface& original, int levels, const Poller& poller) {
  LiftedBase lifted;
  lifted.mesh = build_mesh(coded.triangles);
  const std::vector<uint32_t> number =
      nearest_points(lifted.mesh.positions, moved_vertices(base, original.mesh(), coded));
  lifted.faces = match_faces(lifted.mesh, number, base);
  mark_curves(lifted.mesh.topology, number, lifted.faces, base);
  for (const uint32_t n : number) lifted.vertex.push_back(base.vertex[n]);
  lifted.seams = seam_edges(lifted.mesh);

  DetailLevel level(lifted.mesh.topology);
  EdgeMiddles middles(lifted.faces);
  for (int l = 0; l < levels; ++l) {
    std::vector<SurfacePlace> places = middles.of(level.topology());
    sequence.lift(places, base, poller);
    auto& out = lifted.places.emplace_back();
    out.reserve(places.size());
    for (const SurfacePlace& place : places) out.push_back({place.face, to_float(original.point(place))});
    if (l + 1 == levels) break;
    middles.next();
    level = level.next();
  }
  return lifted;
}

}  // namespace papilio
