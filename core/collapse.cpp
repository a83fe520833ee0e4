#include "collapse.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "flip_slivers.h"

namespace papilio {
namespace {

/// [points] the vertex of each.
std::vector<uint32_t> vertices_of_points(const Mesh& mesh) {
  const uint32_t count = mesh.attributes.empty() ? mesh.topology.vertex_count : mesh.attributes.point_count;
  std::vector<uint32_t> vertex(count, 0);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    vertex[corner_points(mesh)[h]] = mesh.topology.origin[h];
  return vertex;
}

/// Numbers what is used anew, without gaps, in the same order. Returns the old numbers.
std::vector<uint32_t> renumber(Array<uint32_t>& numbers, size_t count) {
  std::vector<uint32_t> next(count, none);
  for (uint32_t n : numbers) next[n] = 0;
  std::vector<uint32_t> kept;
  for (uint32_t n = 0; n < count; ++n) {
    if (next[n] == none) continue;
    next[n] = static_cast<uint32_t>(kept.size());
    kept.push_back(n);
  }
  for (uint32_t& n : numbers) n = next[n];
  return kept;
}

/// The values of some points.
Attribute select(const Attribute& from, const std::vector<uint32_t>& points) {
  Attribute to{from.components, from.unit_length, {}};
  to.values.reserve(from.components * points.size());
  for (size_t p : points)
    for (size_t c = 0; c < from.components; ++c) to.values.push_back(from.values[from.components * p + c]);
  return to;
}

}  // namespace

const Array<uint32_t>& corner_points(const Mesh& mesh) {
  return mesh.attributes.empty() ? mesh.topology.origin : mesh.attributes.point;
}

Collapser::Collapser(const Mesh& mesh, const std::vector<bool>& chosen)
    : mesh_(mesh), vertex_of_point_(vertices_of_points(mesh)), box_(bounding_box(mesh.positions)) {
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    (chosen[Topology::face(h)] ? chosen_ : fixed_).push_back(corner_points(mesh)[h]);
  const Vec3d size = to_double(box_.max) - to_double(box_.min);
  scale_ = std::ldexp(1.0, -1 - std::ilogb(std::max({size.x, size.y, size.z})));
}

Collapsed Collapser::run(const std::vector<bool>& locked, double error) const {
  const Array<Vec3f> positions = place(locked);
  Array<uint32_t> corners(fixed_.begin(), fixed_.end());
  corners.resize(fixed_.size() + chosen_.size());
  const auto target_error = static_cast<float>(error * box_.diagonal() * scale_);
  const size_t left =
      meshopt_simplify(&corners[fixed_.size()], chosen_.data(), chosen_.size(), &positions[0].x, positions.size(),
                       sizeof(Vec3f), 0, target_error, meshopt_SimplifyLockBorder, nullptr);
  corners.resize(fixed_.size() + left);
  Collapsed result = assemble(std::move(corners));
  flip_slivers(result.mesh, static_cast<uint32_t>(fixed_.size() / 3));
  return result;
}

/// The points' positions for meshoptimizer, followed by those of locked vertices once more: in version 0.18 nothing but
/// a point that no face uses, at the same position, makes it leave a vertex alone. (Debian's has asserts that abort, at
/// seams; with three points at each none is one to it.) It scales by the longest side of the box: squares of what a
/// mesh may have need not be numbers, so that is done here, by a power of two, and a last point makes that side
/// exactly 1. So nothing is rounded, and what lies in a line stays there, which lets it avoid faces without area.
Array<Vec3f> Collapser::place(const std::vector<bool>& locked) const {
  const Vec3d origin = to_double(box_.min);
  Array<Vec3f> positions;
  positions.reserve(vertex_of_point_.size() + 1);
  const auto add = [&](uint32_t v) {
    positions.push_back(to_float(scale_ * (to_double(mesh_.positions[v]) - origin)));
  };
  for (uint32_t v : vertex_of_point_) add(v);
  for (uint32_t v = 0; v < locked.size(); ++v)
    if (locked[v]) add(v);
  positions.push_back({1, 1, 1});
  return positions;
}

/// The mesh of these corners, given as points. Vertices and points that none uses are left out.
Collapsed Collapser::assemble(Array<uint32_t> points) const {
  Collapsed out;
  Array<uint32_t> origin(points.size());
  std::ranges::transform(points, origin.begin(), [&](uint32_t p) { return vertex_of_point_[p]; });
  out.vertex = renumber(origin, mesh_.topology.vertex_count);
  for (uint32_t v : out.vertex) out.mesh.positions.push_back(mesh_.positions[v]);
  out.mesh.topology = connect_faces(std::move(origin), static_cast<uint32_t>(out.vertex.size()));
  if (mesh_.attributes.empty()) return out;

  const std::vector<uint32_t> kept = renumber(points, vertex_of_point_.size());
  out.mesh.attributes.point = std::move(points);
  out.mesh.attributes.point_count = static_cast<uint32_t>(kept.size());
  for (const Attribute& attribute : mesh_.attributes.attributes)
    out.mesh.attributes.attributes.push_back(select(attribute, kept));
  return out;
}

}  // namespace papilio
