#include "proto/gltf/surface.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "proto/gltf/vertices.h"

namespace papilio::proto::gltf {
namespace {

/// Number of the attribute that has the coarse face and two of the barycentric coordinates in it.
constexpr size_t provenance = 0;
constexpr size_t provenance_numbers = 3;

/// What a surface needs of a set's vertices.
struct SetVertices {
  Buffer<Vec3f> positions;
  std::vector<uint32_t> equal;
  const Elements* normals = nullptr;

  [[nodiscard]] Vec3d normal(uint32_t vertex) const {
    if (normals == nullptr) return {};
    const double unit = normals->format.unit();
    return {normals->number(vertex, 0) * unit, normals->number(vertex, 1) * unit, normals->number(vertex, 2) * unit};
  }
};

std::vector<SetVertices> vertices_of_sets(const MeshGeometry& geometry) {
  std::vector<SetVertices> sets;
  for (const VertexSet& set : geometry.sets) {
    const VertexStream* normals = set.find("NORMAL");
    const bool has_normals = normals != nullptr && normals->elements.format.components == 3;
    sets.push_back({vertex_positions(set), equal_vertices(set), has_normals ? &normals->elements : nullptr});
  }
  return sets;
}

void append_numbers(std::vector<double>& values, Vec3d numbers) {
  values.insert(values.end(), {numbers.x, numbers.y, numbers.z});
}

Combination combination_of(const Triangle& vertices, double second, double third) {
  std::array<std::pair<uint32_t, double>, 3> parts{
      {{vertices[0], 1 - second - third}, {vertices[1], second}, {vertices[2], third}}};
  std::ranges::sort(parts);
  Combination out;
  size_t count = 0;
  for (const auto& [vertex, weight] : parts) {
    if (weight == 0) continue;
    if (count > 0 && out.vertex[count - 1] == vertex) {
      out.weight[count - 1] += weight;
      continue;
    }
    out.vertex[count] = vertex;
    out.weight[count++] = weight;
  }
  return out;
}

/// A point of the refined surface in the set of its primitive.
struct SetPoint {
  uint32_t set = none;
  uint32_t vertex = 0;  ///< of the refined mesh
  Combination of;
};

std::vector<SetPoint> points_of(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined) {
  std::vector<SetPoint> points(refined.attributes.point_count);
  const std::vector<double>& values = refined.attributes.attributes[provenance].values;
  for (uint32_t h = 0; h < refined.topology.half_edge_count(); ++h) {
    const uint32_t p = refined.attributes.point[h];
    if (points[p].set != none) continue;
    const double* numbers = &values[p * provenance_numbers];
    const auto face = static_cast<size_t>(numbers[0]);
    points[p] = {geometry.primitives[surface.primitive_of[face]].set, refined.topology.origin[h],
                 combination_of(surface.vertices_of[face], numbers[1], numbers[2])};
  }
  return points;
}

}  // namespace

uint32_t Combination::nearest() const {
  return vertex[static_cast<size_t>(std::ranges::max_element(weight) - weight.begin())];
}

Surface join_primitives(const MeshGeometry& geometry) {
  const std::vector<SetVertices> sets = vertices_of_sets(geometry);
  Surface out;
  out.has_normals = std::ranges::any_of(sets, [](const SetVertices& set) { return set.normals != nullptr; });
  TriangleMesh input;
  input.attributes.resize(out.has_normals ? 2 : 1);
  for (Attribute& attribute : input.attributes) attribute.components = 3;
  if (out.has_normals) input.attributes[1].unit_length = true;
  for (uint32_t p = 0; p < geometry.primitives.size(); ++p) {
    const SetVertices& set = sets[geometry.primitives[p].set];
    for (const Triangle& triangle : geometry.primitives[p].triangles) {
      const auto face = static_cast<double>(out.vertices_of.size());
      const auto first = static_cast<uint32_t>(input.positions.size());
      for (const uint32_t vertex : triangle) {
        input.positions.push_back(set.positions[vertex]);
        if (out.has_normals) append_numbers(input.attributes[1].values, set.normal(vertex));
      }
      for (const Vec3d place : {Vec3d{face, 0, 0}, Vec3d{face, 1, 0}, Vec3d{face, 0, 1}})
        append_numbers(input.attributes[provenance].values, place);
      input.triangles.push_back({first, first + 1, first + 2});
      out.primitive_of.push_back(p);
      out.vertices_of.push_back({set.equal[triangle[0]], set.equal[triangle[1]], set.equal[triangle[2]]});
    }
  }
  out.mesh = build_mesh(input, &out.found);
  out.found.welded_points = 0;
  return out;
}

RefinedPrimitives part_primitives(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined,
                                  std::optional<size_t> normals) {
  const std::vector<SetPoint> points = points_of(geometry, surface, refined);
  std::vector<uint32_t> order(points.size());
  for (uint32_t p = 0; p < order.size(); ++p) order[p] = p;
  const auto key = [&](uint32_t p) { return std::tie(points[p].set, points[p].vertex, points[p].of); };
  std::ranges::sort(order, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });

  RefinedPrimitives out{.sets = std::vector<std::vector<RefinedVertex>>(geometry.sets.size())};
  std::vector<uint32_t> number(points.size());  // of each point in its set
  for (size_t i = 0; i < order.size(); ++i) {
    const SetPoint& point = points[order[i]];
    if (point.set == none) continue;
    std::vector<RefinedVertex>& set = out.sets[point.set];
    if (i == 0 || key(order[i - 1]) != key(order[i])) {
      RefinedVertex vertex{.of = point.of, .position = refined.positions[point.vertex], .normal = {0, 0, 1}};
      if (normals) {
        const double* n = &refined.attributes.attributes[*normals].values[size_t{3} * order[i]];
        vertex.normal = {n[0], n[1], n[2]};
      }
      set.push_back(vertex);
    }
    number[order[i]] = static_cast<uint32_t>(set.size() - 1);
  }
  out.triangles.resize(geometry.primitives.size());
  const std::vector<double>& values = refined.attributes.attributes[provenance].values;
  for (uint32_t f = 0; f < refined.topology.face_count(); ++f) {
    const uint32_t* corner = &refined.attributes.point[size_t{3} * f];
    const auto coarse_face = static_cast<size_t>(values[corner[0] * provenance_numbers]);
    out.triangles[surface.primitive_of[coarse_face]].push_back(
        {number[corner[0]], number[corner[1]], number[corner[2]]});
  }
  return out;
}

}  // namespace papilio::proto::gltf
