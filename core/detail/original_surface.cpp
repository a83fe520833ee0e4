#include "detail/original_surface.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "detail/seams.h"
#include "detail/sharp_curves.h"
#include "mesh/fan.h"

namespace papilio {
namespace {

std::array<Vec3d, 3> corners(const Mesh& mesh, uint32_t face) {
  const uint32_t* v = &mesh.topology.origin[size_t{3} * face];
  return {to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]), to_double(mesh.positions[v[2]])};
}

/// Returns [H] the unit normals of the corners, each the area-weighted mean over the faces of its fan.
Buffer<Vec3f> corner_normals(const Mesh& mesh) {
  const Topology& t = mesh.topology;
  Buffer<Vec3f> normals(t.half_edge_count());
  std::vector<bool> is_done(t.half_edge_count());
  Fan fan;
  for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
    if (is_done[h]) continue;
    collect_fan(t, h, fan);
    Vec3d sum;
    for (const uint32_t spoke : fan.spokes) {
      const auto [a, b, c] = corners(mesh, spoke / 3);
      sum += cross(b - a, c - a);
    }
    const double size = length(sum);
    for (const uint32_t spoke : fan.spokes) {
      normals[spoke] = size > 0 ? to_float((1 / size) * sum) : Vec3f{0, 0, 1};
      is_done[spoke] = true;
    }
  }
  return normals;
}

/// Returns positions and faces without attributes.
TriangleMesh surface_of(const Mesh& mesh) {
  TriangleMesh surface{.positions = mesh.positions, .triangles = {}};
  surface.triangles.reserve(mesh.topology.face_count());
  const Buffer<uint32_t>& origin = mesh.topology.origin;
  for (size_t h = 0; h < origin.size(); h += 3) surface.triangles.push_back({origin[h], origin[h + 1], origin[h + 2]});
  return surface;
}

OriginalCurves smooth_seams(const Mesh& mesh, const std::vector<uint32_t>& seams) {
  std::vector<uint32_t> smooth;
  std::ranges::copy_if(seams, std::back_inserter(smooth),
                       [&](uint32_t e) { return mesh.topology.kind[e] == EdgeKind::smooth; });
  return {mesh, smooth, curve_roles(mesh.topology, seams)};
}

}  // namespace

OriginalSurface::OriginalSurface(Mesh mesh)
    : mesh_(std::move(mesh)),
      tree_(surface_of(mesh_)),
      curves_(mesh_),
      seam_edges_(papilio::seam_edges(mesh_)),
      seams_(smooth_seams(mesh_, seam_edges_)),
      normals_(corner_normals(mesh_)),
      face_at_(mesh_.positions.size()),
      is_on_curve_(mesh_.positions.size()),
      diagonal_(bounding_box(mesh_.positions).diagonal()) {
  const Topology& t = mesh_.topology;
  for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
    face_at_[t.origin[h]] = h / 3;
    if (t.kind[t.edge[h]] != EdgeKind::smooth) is_on_curve_[t.origin[h]] = is_on_curve_[t.tip(h)] = 1;
  }
}

Vec3d OriginalSurface::point(const SurfacePlace& place) const {
  const auto [a, b, c] = corners(mesh_, place.face);
  return place.weights.x * a + place.weights.y * b + place.weights.z * c;
}

Vec3d OriginalSurface::normal(uint32_t face, Vec3d point) const {
  const auto [a, b, c] = corners(mesh_, face);
  const Vec3f* n = &normals_[size_t{3} * face];
  const Vec3d across = cross(b - a, c - a);
  const double squared = dot(across, across);
  if (!(squared > 0)) return to_double(n[0]);
  const double wa = std::clamp(dot(across, cross(b - point, c - point)) / squared, 0.0, 1.0);
  const double wb = std::clamp(dot(across, cross(c - point, a - point)) / squared, 0.0, 1 - wa);
  const Vec3d sum = wa * to_double(n[0]) + wb * to_double(n[1]) + (1 - wa - wb) * to_double(n[2]);
  const double size = length(sum);
  return size > 0 ? (1 / size) * sum : Vec3d{};
}

}  // namespace papilio
