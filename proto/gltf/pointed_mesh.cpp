#include "proto/gltf/pointed_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "papilio/error.h"
#include "proto/gltf/vertices.h"

namespace papilio::proto::gltf {
namespace {

using Streams = std::vector<const Elements*>;

/// Returns the elements of all attributes but POSITION.
Streams streams_of(const VertexSet& set) {
  Streams streams;
  for (const VertexStream& stream : set.attributes)
    if (stream.semantic != "POSITION") streams.push_back(&stream.elements);
  return streams;
}

void require_finite(const Streams& streams) {
  for (size_t a = 0; a < streams.size(); ++a) {
    const Elements& elements = *streams[a];
    if (elements.format.type != ComponentType::float32) continue;
    for (uint64_t i = 0; i < elements.count; ++i)
      for (uint32_t c = 0; c < elements.format.components; ++c)
        if (!std::isfinite(elements.number(i, c)))
          throw Error(Fault::not_finite, "Attribute " + std::to_string(a) +
                                             " (the first besides positions is 0) has a value that is NaN or infinite. "
                                             "Repair the mesh, or leave the attribute out.");
  }
}

/// Compares the attributes of two vertices in lexicographic order; returns -1, 0 or 1.
int compare(const Streams& streams, uint32_t one, uint32_t other) {
  for (const Elements* elements : streams)
    for (uint32_t c = 0; c < elements->format.components; ++c) {
      const double a = elements->number(one, c);
      const double b = elements->number(other, c);
      if (a != b) return a < b ? -1 : 1;
    }
  return 0;
}

/// Returns, for each point, the lowest point of its mesh vertex with equal attributes. `vertex` [points]: vertex of the
/// set.
Buffer<uint32_t> find_equal_points(const Mesh& mesh, const Streams& streams, const std::vector<uint32_t>& vertex) {
  const uint32_t count = mesh.attributes.point_count;
  auto equal = Buffer<uint32_t>::for_overwrite(count);
  for (uint32_t p = 0; p < count; ++p) equal[p] = p;
  if (count == mesh.topology.vertex_count) return equal;
  Buffer<uint32_t> mesh_vertex(count);
  Buffer<uint32_t> first(mesh.topology.vertex_count, none);
  Buffer<uint8_t> has_several(mesh.topology.vertex_count);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t v = mesh.topology.origin[h];
    const uint32_t p = mesh.attributes.point[h];
    mesh_vertex[p] = v;
    if (first[v] == none) first[v] = p;
    if (first[v] != p) has_several[v] = 1;
  }
  std::vector<uint32_t> order;
  for (uint32_t p = 0; p < count; ++p)
    if (has_several[mesh_vertex[p]] != 0) order.push_back(p);
  std::ranges::sort(order, [&](uint32_t p, uint32_t q) {
    if (mesh_vertex[p] != mesh_vertex[q]) return mesh_vertex[p] < mesh_vertex[q];
    const int difference = compare(streams, vertex[p], vertex[q]);
    return difference != 0 ? difference < 0 : p < q;
  });
  for (size_t i = 1; i < order.size(); ++i)
    if (mesh_vertex[order[i - 1]] == mesh_vertex[order[i]] &&
        compare(streams, vertex[order[i - 1]], vertex[order[i]]) == 0)
      equal[order[i]] = equal[order[i - 1]];
  return equal;
}

/// Merges points with equal attributes. Numbers points in the order in which the corners first use them.
void merge_points(PointedMesh& pointed, const Streams& streams) {
  PointAttributes& points = pointed.mesh.attributes;
  Buffer<uint32_t> number = find_equal_points(pointed.mesh, streams, pointed.vertex);
  uint32_t kept = 0;
  for (uint32_t p = 0; p < number.size(); ++p) {
    const bool is_first = number[p] == p;
    if (is_first) pointed.vertex[kept] = pointed.vertex[p];
    number[p] = is_first ? kept++ : number[number[p]];
  }
  if (kept == points.point_count) return;
  points.point_count = kept;
  pointed.vertex.resize(kept);
  for (uint32_t& point : points.point) point = number[point];
}

/// Returns whether build_mesh() drops a triangle for two equal corners.
bool is_degenerate(const Triangle& triangle, const Buffer<Vec3f>& positions) {
  const Vec3f& a = positions[triangle[0]];
  const Vec3f& b = positions[triangle[1]];
  const Vec3f& c = positions[triangle[2]];
  return a == b || b == c || c == a;
}

/// Removes the edges, which streams do not need.
void forget_edges(Mesh& mesh) {
  mesh.topology.edge = {};
  mesh.topology.half_edge = {};
  mesh.topology.kind = {};
}

/// Sets the points of a mesh that has all `triangles`: vertices of the set, in the order in which the corners first use
/// them.
void set_points(PointedMesh& pointed, const Buffer<Triangle>& triangles, uint64_t vertices) {
  PointAttributes& points = pointed.mesh.attributes;
  Buffer<uint32_t> number(vertices, none);
  points.point.resize_for_overwrite(3 * triangles.size());
  for (size_t h = 0; h < points.point.size(); ++h) {
    const uint32_t vertex = triangles[h / 3][h % 3];
    if (number[vertex] == none) {
      number[vertex] = points.point_count++;
      pointed.vertex.push_back(vertex);
    }
    points.point[h] = number[vertex];
  }
}

/// Builds a mesh of which the core drops repeated faces. An attribute carries the numbers of the vertices.
PointedMesh build_without_repeated(TriangleMesh input) {
  std::vector<double>& numbers = input.attributes.emplace_back().values;
  for (size_t v = 0; v < input.positions.size(); ++v) numbers.push_back(static_cast<double>(v));
  PointedMesh pointed{.mesh = build_mesh(input), .vertex = {}};
  std::vector<Attribute>& attributes = pointed.mesh.attributes.attributes;
  for (const double number : attributes[0].values) pointed.vertex.push_back(static_cast<uint32_t>(number));
  attributes.clear();
  return pointed;
}

/// Builds a mesh whose points are all vertices of the set that it uses.
PointedMesh build_of_vertices(TriangleMesh input) {
  const auto is_dropped = [&](const Triangle& triangle) { return is_degenerate(triangle, input.positions); };
  if (!std::ranges::all_of(input.triangles, is_dropped)) erase_if(input.triangles, is_dropped);
  BuildReport report;
  PointedMesh pointed{.mesh = build_mesh(input, &report), .vertex = {}};
  if (report.repeated_faces > 0) return build_without_repeated(std::move(input));
  forget_edges(pointed.mesh);
  set_points(pointed, input.triangles, input.positions.size());
  return pointed;
}

}  // namespace

std::vector<double> PointedMesh::values_of(const Elements& elements) const {
  const uint32_t components = elements.format.components;
  std::vector<double> values(vertex.size() * components);
  for (size_t p = 0; p < vertex.size(); ++p)
    for (uint32_t c = 0; c < components; ++c) values[p * components + c] = elements.number(vertex[p], c);
  return values;
}

PointedMesh build_pointed_mesh(VertexSet& set, Buffer<Triangle> triangles) {
  TriangleMesh input{.positions = vertex_positions(set), .triangles = std::move(triangles)};
  for (VertexStream& stream : set.attributes)
    if (stream.semantic == "POSITION") std::string().swap(stream.elements.bytes);
  const Streams streams = streams_of(set);
  if (streams.empty()) {
    PointedMesh plain{.mesh = build_mesh(input), .vertex = {}};
    forget_edges(plain.mesh);
    return plain;
  }
  PointedMesh pointed = build_of_vertices(std::move(input));
  require_finite(streams);
  merge_points(pointed, streams);
  return pointed;
}

}  // namespace papilio::proto::gltf
