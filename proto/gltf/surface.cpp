#include "proto/gltf/surface.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "proto/gltf/vertices.h"

namespace papilio::proto::gltf {
namespace {

/// Index of the attribute with the coarse face and two of the barycentric coordinates in it.
constexpr size_t provenance = 0;
constexpr size_t provenance_numbers = 3;

/// Elements of a set's vertices that a surface uses.
struct SetVertices {
  Buffer<Vec3f> positions;
  std::vector<uint32_t> equal;
  const Elements* normals = nullptr;
  std::vector<const Elements*> displacements{};  ///< [morph target]
};

/// Returns the vector at a vertex; zero without elements.
Vec3d vector_at(const Elements* elements, uint32_t vertex) {
  if (elements == nullptr) return {};
  const double unit = elements->format.unit();
  return {elements->number(vertex, 0) * unit, elements->number(vertex, 1) * unit, elements->number(vertex, 2) * unit};
}

std::vector<SetVertices> vertices_of_sets(const MeshGeometry& geometry) {
  std::vector<SetVertices> sets;
  for (const VertexSet& set : geometry.sets) {
    SetVertices& vertices = sets.emplace_back();
    vertices.positions = vertex_positions(set);
    vertices.equal = equal_vertices(set);
    vertices.normals = find_vectors(set.attributes, "NORMAL");
    for (const auto& target : set.targets) vertices.displacements.push_back(find_vectors(target, "POSITION"));
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

/// Returns a set's smoothing groups; null if it has none.
const VertexStream* find_smoothing_groups(const VertexSet& set) {
  const VertexStream* stream = set.find(smoothing_group_semantic);
  return stream != nullptr && stream->elements.format.components == 1 ? stream : nullptr;
}

}  // namespace

uint32_t Combination::nearest() const {
  return vertex[static_cast<size_t>(std::ranges::max_element(weight) - weight.begin())];
}

namespace {

/// Adds an attribute of all sets to the mesh, and returns its index; nothing if a set lacks it in this format.
std::optional<size_t> add_values(const MeshGeometry& geometry, Surface& surface, const std::string& semantic,
                                 const ElementFormat& format) {
  std::vector<const VertexStream*> streams;  // [set]
  for (const VertexSet& set : geometry.sets) {
    const VertexStream* stream = streams.emplace_back(set.find(semantic));
    if (stream == nullptr || stream->elements.format != format) return std::nullopt;
  }
  PointAttributes& points = surface.mesh.attributes;
  Attribute added{.components = format.components, .values = {}};
  added.values.reserve(size_t{points.point_count} * format.components);
  for (uint32_t point = 0; point < points.point_count; ++point) {
    const double* place = &points.attributes[provenance].values[size_t{point} * provenance_numbers];
    const uint32_t corner = place[1] == 1 ? 1 : place[2] == 1 ? 2 : 0;
    const auto face = static_cast<size_t>(place[0]);
    const uint32_t vertex = surface.vertices_of[face][corner];
    const VertexStream& stream = *streams[geometry.primitives[surface.primitive_of[face]].set];
    for (uint32_t c = 0; c < format.components; ++c) added.values.push_back(stream.elements.number(vertex, c));
  }
  points.attributes.push_back(std::move(added));
  return points.attributes.size() - 1;
}

}  // namespace

void add_packed_values(const MeshGeometry& geometry, Surface& surface) {
  surface.texcoords = add_values(geometry, surface, "TEXCOORD_0", {ComponentType::float32, 2, false});
  surface.colours = add_values(geometry, surface, "COLOR_0", {ComponentType::uint8, 3, true});
}

Surface join_primitives(const MeshGeometry& geometry) {
  const std::vector<SetVertices> sets = vertices_of_sets(geometry);
  Surface out;
  out.has_normals = std::ranges::any_of(sets, [](const SetVertices& set) { return set.normals != nullptr; });
  for (const SetVertices& set : sets) out.target_count = std::max(out.target_count, set.displacements.size());
  std::vector<const VertexStream*> groups;  // [set]
  for (const VertexSet& set : geometry.sets) groups.push_back(find_smoothing_groups(set));
  const bool has_groups = std::ranges::any_of(groups, [](const VertexStream* stream) { return stream != nullptr; });
  TriangleMesh input;
  input.attributes.resize(out.first_displacement() + out.target_count);
  for (size_t a = 0; a < input.attributes.size(); ++a) {
    input.attributes[a].components = 3;
    input.attributes[a].is_displacement = a >= out.first_displacement();
  }
  if (out.has_normals) input.attributes[1].unit_length = true;
  if (has_groups) input.attributes.push_back({.values = {}, .is_smoothing_group = true});
  for (uint32_t p = 0; p < geometry.primitives.size(); ++p) {
    const SetVertices& set = sets[geometry.primitives[p].set];
    for (const Triangle& triangle : geometry.primitives[p].triangles) {
      const auto face = static_cast<double>(out.vertices_of.size());
      const auto first = static_cast<uint32_t>(input.positions.size());
      for (const uint32_t vertex : triangle) {
        input.positions.push_back(set.positions[vertex]);
        if (out.has_normals) append_numbers(input.attributes[1].values, vector_at(set.normals, vertex));
        for (size_t t = 0; t < out.target_count; ++t)
          append_numbers(input.attributes[out.first_displacement() + t].values,
                         vector_at(t < set.displacements.size() ? set.displacements[t] : nullptr, vertex));
        if (has_groups) {
          const VertexStream* stream = groups[geometry.primitives[p].set];
          input.attributes.back().values.push_back(stream == nullptr ? default_smoothing_group
                                                                     : stream->elements.number(vertex, 0));
        }
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

RefinedPoints::RefinedPoints(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined,
                             std::optional<size_t> normals)
    : geometry_(geometry),
      surface_(surface),
      refined_(refined),
      normals_(normals),
      vertex_(refined.attributes.point_count, none) {
  for (uint32_t h = 0; h < refined.topology.half_edge_count(); ++h)
    vertex_[refined.attributes.point[h]] = refined.topology.origin[h];
}

const double* RefinedPoints::provenance_of(uint32_t point) const {
  return &refined_.attributes.attributes[provenance].values[size_t{point} * provenance_numbers];
}

uint32_t RefinedPoints::primitive(uint32_t point) const {
  return surface_.primitive_of[static_cast<size_t>(*provenance_of(point))];
}

uint32_t RefinedPoints::set(uint32_t point) const { return geometry_.primitives[primitive(point)].set; }

Combination RefinedPoints::combination(uint32_t point) const {
  const double* numbers = provenance_of(point);
  return combination_of(surface_.vertices_of[static_cast<size_t>(numbers[0])], numbers[1], numbers[2]);
}

RefinedVertex RefinedPoints::refined_vertex(uint32_t point) const {
  RefinedVertex vertex{.of = combination(point),
                       .position = refined_.positions[this->vertex(point)],
                       .normal = {0, 0, 1},
                       .point = point};
  if (normals_) {
    const double* n = &refined_.attributes.attributes[*normals_].values[size_t{3} * point];
    vertex.normal = {n[0], n[1], n[2]};
  }
  return vertex;
}

RefinedPrimitives part_primitives(const MeshGeometry& geometry, const RefinedPoints& points, const Mesh& refined) {
  RefinedPrimitives out{.sets = std::vector<RefinedVertices>(geometry.sets.size())};
  std::vector<uint32_t> order;  // points by set, vertex and combination
  order.reserve(points.count());
  for (uint32_t p = 0; p < points.count(); ++p)
    if (points.is_used(p)) order.push_back(p);
  const auto place = [&](uint32_t p) { return std::pair(points.set(p), points.vertex(p)); };
  std::ranges::sort(order, [&](uint32_t a, uint32_t b) {
    const auto at_a = place(a);
    const auto at_b = place(b);
    if (at_a != at_b) return at_a < at_b;
    const Combination of_a = points.combination(a);
    const Combination of_b = points.combination(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });

  std::vector<uint32_t> number(points.count());  // [points] number in the set
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t p = order[i];
    RefinedVertices& set = out.sets[points.set(p)];
    set.points = &points;
    const bool repeats =
        i > 0 && place(order[i - 1]) == place(p) && points.combination(order[i - 1]) == points.combination(p);
    if (!repeats) set.numbers.push_back(p);
    number[p] = static_cast<uint32_t>(set.size() - 1);
  }

  std::vector<size_t> counts(geometry.primitives.size());
  const Buffer<uint32_t>& corners = refined.attributes.point;
  for (size_t h = 0; h < corners.size(); h += 3) ++counts[points.primitive(corners[h])];
  out.triangles.resize(counts.size());
  for (size_t p = 0; p < counts.size(); ++p) out.triangles[p].reserve(counts[p]);
  for (size_t h = 0; h < corners.size(); h += 3) {
    const uint32_t* corner = &corners[h];
    out.triangles[points.primitive(corner[0])].push_back({number[corner[0]], number[corner[1]], number[corner[2]]});
  }
  return out;
}

}  // namespace papilio::proto::gltf
