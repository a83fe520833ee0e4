#include "detail/base_points.h"

#include <map>

namespace papilio {

TriangleMesh points_of_base(const BaseMesh& base, const Mesh& original) {
  if (base.point.empty()) return base.triangles;
  TriangleMesh made;
  for (const Attribute& attribute : original.attributes.attributes)
    made.attributes.push_back({.components = attribute.components, .values = {}});
  std::map<uint32_t, uint32_t> number;  // new number by the original's point
  made.triangles.reserve(base.point.size());
  for (size_t f = 0; f < base.point.size(); ++f) {
    Triangle triangle{};
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t point = base.point[f][i];
      const auto [at, is_new] = number.try_emplace(point, static_cast<uint32_t>(made.positions.size()));
      triangle[i] = at->second;
      if (!is_new) continue;
      made.positions.push_back(base.triangles.positions[base.triangles.triangles[f][i]]);
      for (size_t a = 0; a < made.attributes.size(); ++a) {
        const Attribute& of = original.attributes.attributes[a];
        const double* value = &of.values[size_t{of.components} * point];
        made.attributes[a].values.insert(made.attributes[a].values.end(), value, value + of.components);
      }
    }
    made.triangles.push_back(triangle);
  }
  return made;
}

Buffer<Vec3f> moved_vertices(const BaseMesh& base, const Mesh& original, const CodedBase& coded) {
  Buffer<Vec3f> places = base.triangles.positions;
  if (coded.moved.empty()) return places;
  const TriangleMesh points = points_of_base(base, original);
  for (size_t f = 0; f < points.triangles.size(); ++f)
    for (size_t i = 0; i < 3; ++i) places[base.triangles.triangles[f][i]] = coded.moved[points.triangles[f][i]];
  return places;
}

std::vector<Vec3d> sliding_normals(const BaseMesh& base, const OriginalSurface& original) {
  std::vector<Vec3d> normals;
  if (!base.point.empty()) return normals;
  for (const uint32_t v : base.vertex) {
    const Vec3d point = to_double(original.mesh().positions[v]);
    normals.push_back(original.is_on_curve(v) ? Vec3d{} : original.normal(original.face_at(v), point));
  }
  return normals;
}

}  // namespace papilio
