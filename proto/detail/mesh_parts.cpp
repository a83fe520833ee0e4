#include "proto/detail/mesh_parts.h"

#include <algorithm>
#include <map>

namespace papilio::proto::detail {
namespace {

bool are_numbers(const Attribute& attribute) { return attribute.components == 1; }

/// Copier of faces of a mesh and their points, in the mesh's order.
class PartTaker {
 public:
  explicit PartTaker(const TriangleMesh& mesh) : mesh_(mesh), number_(mesh.positions.size(), none) {}

  [[nodiscard]] TriangleMesh take(const std::vector<uint32_t>& faces) {
    TriangleMesh made;
    std::vector<uint32_t> points;
    for (const uint32_t f : faces) points.insert(points.end(), mesh_.triangles[f].begin(), mesh_.triangles[f].end());
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (const uint32_t point : points) {
      number_[point] = static_cast<uint32_t>(made.positions.size());
      made.positions.push_back(Vec3f(mesh_.positions[point]));
    }
    made.triangles.reserve(faces.size());
    for (const uint32_t f : faces) {
      const Triangle& of = mesh_.triangles[f];
      made.triangles.push_back({number_[of[0]], number_[of[1]], number_[of[2]]});
    }
    for (const Attribute& attribute : mesh_.attributes) {
      if (are_numbers(attribute)) continue;
      Attribute& taken = made.attributes.emplace_back();
      taken.components = attribute.components;
      taken.unit_length = attribute.unit_length;
      for (const uint32_t point : points) {
        const auto* value = &attribute.values[size_t{point} * attribute.components];
        taken.values.insert(taken.values.end(), value, value + attribute.components);
      }
    }
    return made;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<uint32_t> number_;  // [points] number in the part
};

}  // namespace

bool has_parts(const std::vector<Attribute>& attributes) { return std::ranges::any_of(attributes, are_numbers); }

std::vector<MeshPart> split_parts(const TriangleMesh& mesh) {
  const auto numbers = std::ranges::find_if(mesh.attributes, are_numbers);
  std::vector<MeshPart> parts;
  if (numbers == mesh.attributes.end()) {
    parts.push_back({.triangles = mesh});
    return parts;
  }
  std::map<double, std::vector<uint32_t>> faces;  // by part number
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) faces[numbers->values.at(mesh.triangles[f][0])].push_back(f);
  PartTaker taker(mesh);
  for (const auto& [number, of] : faces) parts.push_back({number, taker.take(of)});
  return parts;
}

TriangleMesh join_parts(std::vector<MeshPart> parts) {
  if (parts.size() == 1) return std::move(parts[0].triangles);
  TriangleMesh made;
  Attribute numbers;
  for (const MeshPart& part : parts) {
    const auto first = static_cast<uint32_t>(made.positions.size());
    made.positions.insert(made.positions.end(), part.triangles.positions.begin(), part.triangles.positions.end());
    for (const auto& [a, b, c] : part.triangles.triangles) made.triangles.push_back({first + a, first + b, first + c});
    made.attributes.resize(part.triangles.attributes.size());
    for (size_t i = 0; i < made.attributes.size(); ++i) {
      const Attribute& from = part.triangles.attributes[i];
      made.attributes[i].components = from.components;
      made.attributes[i].unit_length = from.unit_length;
      made.attributes[i].values.insert(made.attributes[i].values.end(), from.values.begin(), from.values.end());
    }
    numbers.values.resize(made.positions.size(), part.number);
  }
  made.attributes.push_back(std::move(numbers));
  return made;
}

}  // namespace papilio::proto::detail
