// Writer of OBJ files; obj.cpp is their reader.

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/text_writer.h"

namespace papilio::client {
namespace {

using proto::AttributeKind;

/// Returns the values of the first attribute of a kind, three numbers a point, with zero for a missing third; empty if
/// there is none.
Buffer<Vec3f> find_attribute(const TriangleMesh& mesh, const proto::MeshFormat& format, AttributeKind kind,
                             uint32_t& components) {
  for (size_t a = 0; a < format.attributes.size(); ++a) {
    const Attribute& attribute = mesh.attributes[a];
    components = attribute.components;
    if (format.attributes[a].kind != kind || components > 3 || (kind == AttributeKind::normal && components != 3))
      continue;
    const double unit = proto::unit_value(format.attributes[a]);
    auto found = Buffer<Vec3f>::for_overwrite(mesh.positions.size());
    for (size_t p = 0; p < found.size(); ++p) {
      std::array<float, 3> numbers{};
      for (uint32_t i = 0; i < components; ++i)
        numbers[i] = static_cast<float>(attribute.values[p * components + i] / unit);
      found[p] = {numbers[0], numbers[1], numbers[2]};
    }
    return found;
  }
  return {};
}

/// Returns the smoothing group of each point; empty if there are none.
std::span<const double> find_groups(const TriangleMesh& mesh, const proto::MeshFormat& format) {
  for (size_t a = 0; a < format.attributes.size(); ++a)
    if (proto::is_smoothing_group(format.attributes[a], mesh.attributes[a].components))
      return mesh.attributes[a].values;
  return {};
}

/// Appends the line that sets the group of later faces.
void append_group(std::string& text, double group) {
  text += 's';
  if (group == 0)
    text += " off";
  else
    append_number(text, static_cast<uint64_t>(std::max(group, 0.0)));
  text += '\n';
}

/// Returns the order in which triangles are written: unchanged, or with materials by material, `none` first.
std::vector<uint32_t> writing_order(const TriangleMesh& mesh, const ObjMaterials& materials) {
  std::vector<uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  if (materials.of_triangle.empty()) return order;
  const auto rank = [&](uint32_t t) { return materials.of_triangle.at(t) + 1; };  // `none` is the largest number
  std::ranges::stable_sort(order, [&](uint32_t t, uint32_t u) { return rank(t) < rank(u); });
  return order;
}

/// Removes repeated values, and returns the new index of each.
std::vector<uint32_t> drop_repeated(Buffer<Vec3f>& values) {
  const auto bits = [&](uint32_t p) {  // bits are ordered even if a value is NaN
    return std::array{std::bit_cast<uint32_t>(values[p].x), std::bit_cast<uint32_t>(values[p].y),
                      std::bit_cast<uint32_t>(values[p].z)};
  };
  std::vector<uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](uint32_t p, uint32_t q) { return std::pair(bits(p), p) < std::pair(bits(q), q); });
  std::vector<uint32_t> place(values.size());
  for (size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && bits(order[i]) == bits(order[i - 1]) ? place[order[i - 1]] : order[i];
  uint32_t kept = 0;
  for (uint32_t p = 0; p < values.size(); ++p) {
    if (place[p] == p) {
      values[kept] = values[p];
      place[p] = kept++;
    } else {
      place[p] = place[place[p]];
    }
  }
  values.resize(kept);
  return place;
}

}  // namespace

std::string format_obj(const TriangleMesh& mesh, const proto::MeshFormat& format, const ObjMaterials& materials) {
  uint32_t texture_components = 0;
  uint32_t normal_components = 0;
  Buffer<Vec3f> textures = find_attribute(mesh, format, AttributeKind::tex_coord, texture_components);
  Buffer<Vec3f> normals = find_attribute(mesh, format, AttributeKind::normal, normal_components);
  Buffer<Vec3f> positions = mesh.positions;
  std::vector<uint32_t> position(positions.size());
  std::iota(position.begin(), position.end(), 0);
  // Points that differ only in attributes are one vertex, which stays whole when the file is read.
  const std::span<const double> groups = find_groups(mesh, format);
  if (!textures.empty() || !normals.empty() || !groups.empty()) position = drop_repeated(positions);
  const std::vector<uint32_t> texture = drop_repeated(textures);
  const std::vector<uint32_t> normal = drop_repeated(normals);

  std::string text =
      "# " + std::to_string(positions.size()) + " vertices, " + std::to_string(mesh.triangles.size()) + " triangles\n";
  for (const std::string& library : materials.libraries) text += "mtllib " + library + '\n';
  for (const Vec3f& p : positions) append_line(text, "v", {p.x, p.y, p.z});
  for (const Vec3f& t : textures)
    texture_components == 3 ? append_line(text, "vt", {t.x, t.y, t.z}) : append_line(text, "vt", {t.x, t.y});
  for (const Vec3f& n : normals) append_line(text, "vn", {n.x, n.y, n.z});
  std::optional<double> group;
  uint32_t material = none;
  for (const uint32_t t : writing_order(mesh, materials)) {
    const Triangle& triangle = mesh.triangles[t];
    if (!materials.of_triangle.empty() && material != materials.of_triangle[t]) {
      material = materials.of_triangle[t];
      text += "usemtl " + materials.names.at(material) + '\n';
    }
    if (!groups.empty() && group != groups[triangle[0]]) append_group(text, *(group = groups[triangle[0]]));
    text += 'f';
    for (const uint32_t p : triangle) {
      append_number(text, uint64_t{position[p]} + 1);
      if (!texture.empty()) append_number(text, uint64_t{texture[p]} + 1, '/');
      if (!normal.empty() && texture.empty()) text += '/';
      if (!normal.empty()) append_number(text, uint64_t{normal[p]} + 1, '/');
    }
    text += '\n';
  }
  return text;
}

}  // namespace papilio::client
