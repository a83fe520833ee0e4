#include "mesh/displacement.h"

#include <algorithm>
#include <limits>

#include "mesh/attributes.h"

namespace papilio {

Displacements displacements_at_vertices(const Mesh& mesh) {
  Displacements out;
  for (uint32_t a = 0; a < mesh.attributes.attributes.size(); ++a) {
    const Attribute& attribute = mesh.attributes.attributes[a];
    if (!attribute.is_displacement) continue;
    out.push_back({a, Buffer<Vec3d>(mesh.topology.vertex_count)});
    Buffer<Vec3d>& at = out.back().at;
    Buffer<uint8_t> is_set(mesh.topology.vertex_count, 0);
    for (HalfEdgeId h = 0; h < mesh.topology.half_edge_count(); ++h) {
      const Vec3d of_point = vector_at(attribute, mesh.attributes.point[h]);
      const VertexId v = mesh.topology.origin[h];
      if (is_set[v] == 0)
        at[v] = of_point;
      else if (at[v] != of_point)
        at[v] = unknown_displacement();
      is_set[v] = 1;
    }
  }
  return out;
}

void append_new_vertices(Displacements& at_vertices, const Displacements& at_edges, const Marks& split) {
  for (size_t i = 0; i < at_vertices.size(); ++i)
    for (EdgeId e : marked(split)) at_vertices[i].at.push_back(at_edges[i].at[e]);
}

bool has_displacements(const PointAttributes& attributes) {
  return std::ranges::any_of(attributes.attributes, &Attribute::is_displacement);
}

Vec3d unknown_displacement() {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  return {not_a_number, not_a_number, not_a_number};
}

}  // namespace papilio
