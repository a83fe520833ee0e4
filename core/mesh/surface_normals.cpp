#include "mesh/surface_normals.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "base/sort.h"
#include "base/trigonometry.h"
#include "mesh/attributes.h"
#include "mesh/normals.h"
#include "papilio/mesh.h"

namespace papilio {
namespace {

void put_value(Attribute& attribute, uint32_t point, Vec3d value) {
  double* v = &attribute.values[size_t{3} * point];
  std::tie(v[0], v[1], v[2]) = std::tuple{value.x, value.y, value.z};
}

/// Cosine of a degree, the largest angle between normals that count as equal: rounding may split one normal.
constexpr double same_cosine = 0.99985;
/// Upper bound of the points of its vertex that a point is compared with: those before it in the order of values.
constexpr size_t most_compared = 16;

bool are_same(Vec3d a, Vec3d b) {
  const double product = dot(a, b);
  return a == b || (product > 0 && product * product > same_cosine * same_cosine * dot(a, a) * dot(b, b));
}

/// Returns, for each point, the representative of the points of its vertex with equal values, within a degree.
std::vector<uint32_t> find_equal_points(const Mesh& mesh, const Attribute& attribute) {
  const PointAttributes& points = mesh.attributes;
  std::vector<uint32_t> vertex(points.point_count, none);
  for (HalfEdgeId h = 0; h < mesh.topology.half_edge_count(); ++h) vertex[points.point[h]] = mesh.topology.origin[h];
  std::vector<uint32_t> order(points.point_count);
  std::vector<uint32_t> equal(points.point_count);
  for (uint32_t p = 0; p < order.size(); ++p) order[p] = equal[p] = p;
  if (points.point_count == mesh.topology.vertex_count) return equal;
  const auto place = [&](uint32_t p) {
    const Vec3d v = vector_at(attribute, p);
    return std::tuple{vertex[p], v.x, v.y, v.z, p};
  };
  sort_range(order, [&](uint32_t p, uint32_t q) { return place(p) < place(q); });
  std::vector<uint32_t> kept;  // representatives at the current vertex
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t p = order[i];
    if (i > 0 && vertex[order[i - 1]] != vertex[p]) kept.clear();
    const auto first = kept.begin() + static_cast<ptrdiff_t>(kept.size() - std::min(kept.size(), most_compared));
    const auto same = std::find_if(first, kept.end(), [&](uint32_t other) {
      return are_same(vector_at(attribute, other), vector_at(attribute, p));
    });
    if (same == kept.end())
      kept.push_back(p);
    else
      equal[p] = *same;
  }
  return equal;
}

/// Returns [H] the sector of each corner, and their count. A sector is a run of corners at one vertex, from curve to
/// curve or all the way round.
std::vector<uint32_t> find_sectors(const Topology& mesh, uint32_t& count) {
  std::vector<uint32_t> sector(mesh.half_edge_count(), none);
  const auto clockwise = [&](HalfEdgeId h) { return mesh.is_curve(h) ? none : Topology::next(mesh.twin[h]); };
  const auto counter_clockwise = [&](HalfEdgeId h) {
    const HalfEdgeId incoming = h.previous();
    return mesh.is_curve(incoming) ? none : mesh.twin[incoming];
  };
  count = 0;
  for (uint32_t start = 0; start < mesh.half_edge_count(); ++start) {
    if (sector[start] != none) continue;
    for (HalfEdgeId h = start; h != none && sector[h] == none; h = counter_clockwise(h)) sector[h] = count;
    for (HalfEdgeId h = clockwise(start); h != none && sector[h] == none; h = clockwise(h)) sector[h] = count;
    ++count;
  }
  return sector;
}

/// Returns the angle of a face at a corner, in radians.
double angle_at(const Mesh& mesh, HalfEdgeId h) {
  const Vec3d place = to_double(mesh.positions[mesh.topology.origin[h]]);
  const Vec3d one = to_double(mesh.positions[mesh.topology.tip(h)]) - place;
  const Vec3d other = to_double(mesh.positions[mesh.topology.apex(h)]) - place;
  const double lengths = length(one) * length(other);
  if (!(lengths > 0)) return 0;
  const double cosine = std::clamp(dot(one, other) / lengths, -1.0, 1.0);
  return cosine < 0 ? std::numbers::pi - arc_cosine(-cosine) : arc_cosine(cosine);
}

/// Returns [count] the weighted sums of face normals over groups of corners; of(h) is the group, below `count`.
template <class Of>
std::vector<Vec3d> sum_normals(const Mesh& mesh, uint32_t count, FaceWeight weight, const Of& of) {
  std::vector<Vec3d> sums(count);
  for (FaceId f = 0; f < mesh.topology.face_count(); ++f) {
    const Vec3d normal = area_normal(mesh, f);
    const double size = length(normal);
    if (!(size > 0)) continue;
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h)
      sums[of(h)] += weight == FaceWeight::area ? normal : angle_at(mesh, h) / size * normal;
  }
  return sums;
}

}  // namespace

void renew_normals(Mesh& mesh, size_t number) {
  Attribute& attribute = mesh.attributes.attributes[number];
  const Buffer<uint32_t>& point = mesh.attributes.point;
  const std::vector<uint32_t> equal = find_equal_points(mesh, attribute);
  const std::vector<Vec3d> sums =
      sum_normals(mesh, mesh.attributes.point_count, FaceWeight::area, [&](HalfEdgeId h) { return equal[point[h]]; });
  double agreement = 0;
  for (uint32_t p = 0; p < sums.size(); ++p) agreement += dot(sums[p], vector_at(attribute, p));
  for (uint32_t p = 0; p < sums.size(); ++p) {
    const Vec3d sum = sums[equal[p]];
    const double size = length(sum);
    if (size > 0) put_value(attribute, p, (agreement < 0 ? -1 : 1) / size * sum);
  }
}

void add_normals(Mesh& mesh) { add_weighted_normals(mesh, FaceWeight::area); }

void add_weighted_normals(Mesh& mesh, FaceWeight weight) {
  PointAttributes& attributes = mesh.attributes;
  uint32_t sectors = 0;
  const std::vector<uint32_t> sector = find_sectors(mesh.topology, sectors);
  std::vector<uint32_t> sector_of;  // sector of each new point
  std::vector<uint32_t> old_point;  // old point of each new point, if there are attributes
  if (attributes.empty()) {
    attributes.point.assign(sector.size(), 0);
    std::ranges::copy(sector, attributes.point.begin());
    for (uint32_t s = 0; s < sectors; ++s) sector_of.push_back(s);
  } else {
    std::vector<std::pair<uint64_t, uint32_t>> corners(sector.size());  // (sector, old point) and half-edge
    for (HalfEdgeId h = 0; h < sector.size(); ++h) corners[h] = {uint64_t{sector[h]} << 32 | attributes.point[h], h};
    sort_range(corners);
    for (size_t i = 0; i < corners.size(); ++i) {
      const auto [both, h] = corners[i];
      if (i == 0 || both != corners[i - 1].first) {
        sector_of.push_back(static_cast<uint32_t>(both >> 32));
        old_point.push_back(static_cast<uint32_t>(both));
      }
      attributes.point[h] = static_cast<uint32_t>(sector_of.size() - 1);
    }
  }
  attributes.point_count = static_cast<uint32_t>(sector_of.size());
  for (Attribute& attribute : attributes.attributes) {
    std::vector<double> values;
    values.reserve(old_point.size() * attribute.components);
    for (uint32_t p : old_point) {
      const auto value = values_of(attribute, p);
      values.insert(values.end(), value.begin(), value.end());
    }
    attribute.values = std::move(values);
  }
  const std::vector<Vec3d> sums = sum_normals(mesh, sectors, weight, [&](HalfEdgeId h) { return sector[h]; });
  Attribute normals{.components = 3, .unit_length = true, .values = std::vector<double>(3 * sector_of.size())};
  for (uint32_t p = 0; p < sector_of.size(); ++p) {
    const Vec3d sum = sums[sector_of[p]];
    const double size = length(sum);
    put_value(normals, p, size > 0 ? 1 / size * sum : Vec3d{0, 0, 1});
  }
  attributes.attributes.push_back(std::move(normals));
}

}  // namespace papilio
