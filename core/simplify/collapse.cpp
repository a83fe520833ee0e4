#include "simplify/collapse.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/sort.h"
#include "mesh/connect.h"
#include "simplify/flip_slivers.h"

namespace papilio {
namespace {

/// Returns [H] the point at each corner, or the vertex without attributes: a vertex of meshoptimizer.
const Buffer<uint32_t>& corner_points(const Mesh& mesh) {
  return mesh.attributes.empty() ? mesh.topology.origin : mesh.attributes.point;
}

/// Returns [points] the vertex of each point.
std::vector<uint32_t> vertices_of_points(const Mesh& mesh) {
  const uint32_t count = mesh.attributes.empty() ? mesh.topology.vertex_count : mesh.attributes.point_count;
  std::vector<uint32_t> vertex(count, 0);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    vertex[corner_points(mesh)[h]] = mesh.topology.origin[h];
  return vertex;
}

/// Replaces numbers by compact indices in their order. Returns the old numbers.
std::vector<uint32_t> renumber(Buffer<uint32_t>& numbers, size_t count) {
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

/// Returns an attribute with the values of some points.
Attribute select(const Attribute& from, const std::vector<uint32_t>& points) {
  Attribute to{from.components, from.unit_length, {}, from.is_smoothing_group, from.is_displacement};
  to.values.reserve(from.components * points.size());
  for (size_t p : points)
    for (size_t c = 0; c < from.components; ++c) to.values.push_back(from.values[from.components * p + c]);
  return to;
}

}  // namespace

Collapser::Collapser(const Mesh& mesh, const std::vector<bool>& chosen, std::function<void()> poll)
    : mesh_(mesh),
      poll_(std::move(poll)),
      vertex_of_point_(vertices_of_points(mesh)),
      is_locked_(mesh.topology.vertex_count),
      box_(bounding_box(mesh.positions)) {
  std::vector<bool> to_collapse = chosen;
  set_aside(chosen, to_collapse);
  split_into_parts(std::move(to_collapse));
  lock_borders();
  const Vec3d size = to_double(box_.max) - to_double(box_.min);
  scale_ = std::ldexp(1.0, -1 - std::ilogb(std::max({size.x, size.y, size.z})));
}

namespace {

/// Appends the face's corners.
void append(std::vector<uint32_t>& corners, const Mesh& mesh, uint32_t face) {
  const auto first = corner_points(mesh).begin() + 3 * face;
  corners.insert(corners.end(), first, first + 3);
}

}  // namespace

void Collapser::set_aside(const std::vector<bool>& chosen, std::vector<bool>& to_collapse) {
  const Buffer<uint32_t>& origin = mesh_.topology.origin;
  std::vector<uint32_t> faces(mesh_.topology.vertex_count, 0);  // number of chosen faces
  for (uint32_t h = 0; h < origin.size(); ++h) faces[origin[h]] += chosen[Topology::face(h)] ? 1 : 0;
  for (uint32_t h = 0; h < origin.size(); ++h)
    if (faces[origin[h]] > most_faces_at_vertex) to_collapse[Topology::face(h)] = false;
  for (const bool was_chosen : {false, true})
    for (uint32_t f = 0; f < mesh_.topology.face_count(); ++f)
      if (chosen[f] == was_chosen && !to_collapse[f]) append(fixed_, mesh_, f);
  for (uint32_t point : fixed_) is_locked_[vertex_of_point_[point]] = true;
}

// Grows each part from a first face across edges.
void Collapser::split_into_parts(std::vector<bool> to_collapse) {
  const auto count = static_cast<size_t>(std::ranges::count(to_collapse, true));
  const auto take = [&](uint32_t f) {
    if (f == none || !to_collapse[f]) return false;
    to_collapse[f] = false;
    return true;
  };
  std::vector<uint32_t> faces;
  const auto end_part = [&] {
    if (faces.empty()) return;
    sort_range(faces);
    Corners& part = parts_.emplace_back();
    for (uint32_t f : faces) append(part, mesh_, f);
    faces.clear();
  };
  size_t next = 0;  // first of `faces` whose neighbours are not yet taken
  for (uint32_t f = 0; f < mesh_.topology.face_count(); ++f) {
    if (!take(f)) continue;
    faces.push_back(f);
    if (count <= most_faces) continue;  // one part of all faces, connected or not
    for (; next < faces.size() && faces.size() < most_faces; ++next)
      for (uint32_t h = 3 * faces[next]; h < 3 * faces[next] + 3 && faces.size() < most_faces; ++h) {
        const uint32_t t = mesh_.topology.twin[h];
        if (t != none && take(Topology::face(t))) faces.push_back(Topology::face(t));
      }
    if (faces.size() == most_faces) {
      end_part();
      next = 0;
    }
  }
  end_part();
}

// Locks the vertices between parts. In all parts but the last at such a vertex, locks also the vertices of its faces:
// two parts might join one pair of vertices.
void Collapser::lock_borders() {
  std::vector<uint32_t> last(mesh_.topology.vertex_count, 0);  // last part at the vertex
  for (uint32_t part = 0; part < parts_.size(); ++part)
    for (uint32_t point : parts_[part]) last[vertex_of_point_[point]] = part;
  for (uint32_t part = 0; part < parts_.size(); ++part)
    for (size_t c = 0; c < parts_[part].size(); c += 3) {
      const auto vertex = [&](size_t i) { return vertex_of_point_[parts_[part][c + i]]; };
      if (last[vertex(0)] == part && last[vertex(1)] == part && last[vertex(2)] == part) continue;
      for (size_t i = 0; i < 3; ++i) is_locked_[vertex(i)] = true;
    }
}

Collapsed Collapser::run(const std::vector<bool>& locked, double error) const {
  Buffer<uint32_t> corners(fixed_.begin(), fixed_.end());
  for (const Corners& part : parts_) {
    poll_();
    collapse(part, locked, error, corners);
  }
  Collapsed result = assemble(std::move(corners));
  flip_slivers(result.mesh, static_cast<uint32_t>(fixed_.size() / 3));
  return result;
}

// Appends the simplified part to `out`.
void Collapser::collapse(const Corners& part, const std::vector<bool>& locked, double error,
                         Buffer<uint32_t>& out) const {
  Corners points = part;  // points of the part, in ascending order
  sort_range(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Corners own(part.size());
  std::ranges::transform(part, own.begin(), [&](uint32_t p) {
    return static_cast<uint32_t>(std::ranges::lower_bound(points, p) - points.begin());
  });
  const Buffer<Vec3f> positions = place(points, locked);
  const auto target_error = static_cast<float>(error * box_.diagonal() * scale_);
  Corners left(own.size());
  left.resize(meshopt_simplify(left.data(), own.data(), own.size(), &positions[0].x, positions.size(), sizeof(Vec3f), 0,
                               target_error, meshopt_SimplifyLockBorder, nullptr));
  for (uint32_t p : left) out.push_back(points[p]);
}

// Returns positions for meshoptimizer: of the points, then of locked vertices again. In version 0.18 only an unused
// point at the same position locks a vertex. (With three points at each position, Debian's asserts at seams do not
// abort.)
//
// meshoptimizer scales by the longest side of the box, and squares of coordinates may overflow. So positions are scaled
// here by a power of two, and the last three points make the longest side exactly 1. Nothing is rounded, and collinear
// points stay collinear, so that meshoptimizer can avoid faces without area.
Buffer<Vec3f> Collapser::place(const std::vector<uint32_t>& points, const std::vector<bool>& locked) const {
  const Vec3d origin = to_double(box_.min);
  Buffer<Vec3f> positions;
  positions.reserve(2 * points.size() + 3);
  const auto add = [&](uint32_t v) {
    positions.push_back(to_float(scale_ * (to_double(mesh_.positions[v]) - origin)));
  };
  for (uint32_t p : points) add(vertex_of_point_[p]);
  for (uint32_t p : points) {
    const uint32_t v = vertex_of_point_[p];
    if (locked[v] || is_locked_[v]) add(v);
  }
  positions.insert(positions.end(), {{0, 1, 1}, {1, 0, 1}, {1, 1, 0}});
  return positions;
}

// Builds the mesh of these corners, given as points. Drops unused vertices and points.
Collapsed Collapser::assemble(Buffer<uint32_t> points) const {
  Collapsed out;
  auto origin = Buffer<uint32_t>::for_overwrite(points.size());
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
