// Wavefront OBJ: `v x y z`, `vt u v`, `vn x y z` and `f 1/1/1 2/2/2 3/3/3`, with indices from 1, or negative ones back
// from the latest. A face may precede its vertices. `s 1` and `s off` set the smoothing group of later faces, `usemtl
// NAME` their material, and `mtllib FILE` a material library. Other keywords are skipped.

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/polygon.h"
#include "client/mesh_file/text_scanner.h"
#include "papilio/mesh.h"

namespace papilio::client {
namespace {

using proto::AttributeKind;

constexpr uint32_t nowhere = none - 1;  ///< index that is always out of range

/// Indices of position, texture coordinate and normal of a face's corner, from zero; `none` if absent. `group`: the
/// face's smoothing group.
struct Corner {
  uint32_t position = none, texture = none, normal = none, group = 0;
  friend bool operator==(const Corner&, const Corner&) = default;
  friend bool operator<(const Corner& a, const Corner& b) {
    return std::tie(a.position, a.texture, a.normal, a.group) < std::tie(b.position, b.texture, b.normal, b.group);
  }
};

/// Lists of the file, before they are combined to points.
struct Lists {
  Buffer<Vec3f> positions, textures, normals;
  std::vector<Corner> corners;
  PolygonList faces;  ///< faces, as numbers of corners
  std::vector<std::string> libraries;
  std::vector<std::string> materials;
  std::vector<uint32_t> material_of_face;  ///< [faces] index in `materials`, or `none`
};

uint32_t from_zero(int64_t index, size_t so_far) {
  const int64_t number = index < 0 ? static_cast<int64_t>(so_far) + index : index - 1;
  return number < 0 || number >= nowhere ? nowhere : static_cast<uint32_t>(number);
}

/// Consumes "/7" at the begin of `rest`, the texture coordinate or normal of a corner; returns its index.
uint32_t parse_optional(std::string_view& rest, size_t so_far) {
  if (!rest.empty()) rest.remove_prefix(1);
  const std::string_view number = rest.substr(0, rest.find('/'));
  rest.remove_prefix(number.size());
  int64_t index = 0;
  if (number.empty()) return none;
  return parse_number(number, index) ? from_zero(index, so_far) : nowhere;
}

/// Parses a face's corner: `7`, `7/1`, `7//3` or `7/1/3`.
Corner parse_corner(const TextScanner& scanner, std::string_view word, const Lists& lists) {
  const std::string_view number = word.substr(0, word.find('/'));
  std::string_view rest = word.substr(number.size());
  int64_t index = 0;
  if (!parse_number(number, index) || rest.find_first_not_of("/-0123456789") != std::string_view::npos)
    scanner.fail("expected the number of a vertex, found " + quoted(word));
  Corner corner{.position = from_zero(index, lists.positions.size())};
  if (corner.position == nowhere) scanner.fail("there is no vertex " + std::to_string(index));
  corner.texture = parse_optional(rest, lists.textures.size());
  corner.normal = parse_optional(rest, lists.normals.size());
  return corner;
}

/// Parses one to three numbers; missing ones are zero.
Vec3f parse_texture(TextScanner& scanner) {
  std::array<float, 3> numbers{scanner.coordinate()};
  for (size_t i = 1; i < numbers.size(); ++i) {
    const std::string_view word = scanner.word();
    if (word.empty()) break;
    if (!parse_number(word, numbers[i])) scanner.fail("expected a number that a float can hold, found " + quoted(word));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

/// Numbering of a file's smoothing groups: 0 for `off`, else from 1 in order of appearance, as the author's numbers may
/// be bit masks. Faces before the first `s` are a separate group.
class SmoothingGroups {
 public:
  [[nodiscard]] uint32_t current() const { return current_; }
  /// Sets the group from the word after `s`; ignores a word that is no number.
  void set(std::string_view word) {
    int64_t number = 0;
    if (word == "off")
      number = 0;
    else if (!parse_number(word, number))
      return;
    current_ = number == 0 ? 0 : numbers_.try_emplace(number, numbers_.size() + 2).first->second;
  }

 private:
  std::map<int64_t, uint32_t> numbers_;
  uint32_t current_ = 1;
};

/// Numbering of a file's materials in the order in which faces first use them.
class MaterialNames {
 public:
  /// Sets the material from the text after `usemtl`.
  void use(std::string_view name) {
    name_ = name;
    number_ = std::nullopt;
  }
  /// Returns the material of the next face; `none` before the first `usemtl`. Adds new ones to `names`.
  [[nodiscard]] uint32_t of_face(std::vector<std::string>& names, const TextScanner& scanner) {
    if (number_) return *number_;
    const auto [known, is_new] = numbers_.try_emplace(name_, static_cast<uint32_t>(names.size()));
    if (is_new && names.size() == most_materials) scanner.fail("there are more than 65536 materials");
    if (is_new) names.push_back(name_);
    number_ = known->second;
    return *number_;
  }

 private:
  std::map<std::string, uint32_t> numbers_;
  std::string name_;
  std::optional<uint32_t> number_ = none;  ///< number of the latest name, once a face uses it
};

/// Adds the libraries after `mtllib`.
void add_library(Lists& lists, std::string_view names, const TextScanner& scanner) {
  if (names.empty() || std::ranges::find(lists.libraries, names) != lists.libraries.end()) return;
  if (lists.libraries.size() == most_libraries) scanner.fail("there are more than 1024 different lines mtllib");
  lists.libraries.emplace_back(names);
}

Lists parse_lists(std::string_view bytes) {
  TextScanner scanner(bytes, {.hash_comments = true, .backslash_continues = true});
  Lists lists;
  std::vector<uint32_t> face;
  SmoothingGroups groups;
  MaterialNames materials;
  for (bool more = scanner.to_word(); more; more = scanner.next_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "v" || keyword == "vn") {
      const float x = scanner.coordinate(), y = scanner.coordinate(), z = scanner.coordinate();
      (keyword == "v" ? lists.positions : lists.normals).push_back({x, y, z});
    } else if (keyword == "vt") {
      lists.textures.push_back(parse_texture(scanner));
    } else if (keyword == "s") {
      groups.set(scanner.word());
    } else if (keyword == "usemtl") {
      materials.use(scanner.rest_of_line());
    } else if (keyword == "mtllib") {
      add_library(lists, scanner.rest_of_line(), scanner);
    } else if (keyword == "f") {
      face.clear();
      for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
        face.push_back(static_cast<uint32_t>(lists.corners.size()));
        lists.corners.push_back(parse_corner(scanner, word, lists));
        lists.corners.back().group = groups.current();
      }
      if (face.size() < 3) {  // a point or a line, as some writers put loose edges
        if (scanner.remaining() == 0) scanner.fail("the file ends within a face: it is cut short");
        lists.corners.resize(lists.corners.size() - face.size());
        continue;
      }
      lists.faces.add(face);
      lists.material_of_face.push_back(materials.of_face(lists.materials, scanner));
    }
  }
  return lists;
}

/// Returns the triangles of all faces, and the face of each. Corners without a position have NaN.
Buffer<Triangle> triangulate(const Lists& lists, std::vector<uint32_t>* face_of) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto position_of = [&](uint32_t corner) {
    const uint32_t position = lists.corners[corner].position;
    return position < lists.positions.size() ? lists.positions[position] : Vec3f{nan, nan, nan};
  };
  return lists.faces.triangles(position_of, face_of);
}

/// Returns whether any corner uses one of the `listed` values; without any, indices of corners are ignored.
bool are_used(std::vector<Corner>& corners, uint32_t Corner::*member, const Buffer<Vec3f>& listed, const char* what) {
  bool used = false;
  for (Corner& corner : corners) {
    if (listed.empty()) corner.*member = none;
    if (corner.*member == none) continue;
    used = true;
    if (corner.*member >= listed.size()) throw ParseError(std::string("a face names a ") + what + " that is not there");
  }
  return used;
}

/// Returns whether faces have different smoothing groups; if not, removes the groups.
bool have_groups(std::vector<Corner>& corners) {
  const bool differ = std::ranges::any_of(corners, [&](const Corner& c) { return c.group != corners[0].group; });
  if (!differ)
    for (Corner& corner : corners) corner.group = 0;
  return differ;
}

/// Combines corners to points, and sets each of `point_of_corner`. Points are in the order of positions, at least one
/// for each.
std::vector<Corner> make_points(const Lists& lists, std::vector<uint32_t>& point_of_corner) {
  const std::vector<Corner>& corners = lists.corners;
  std::vector<uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](uint32_t a, uint32_t b) { return corners[a] < corners[b]; });
  point_of_corner.resize(corners.size());
  std::vector<Corner> points;
  size_t next = 0;
  for (uint32_t p = 0; p < lists.positions.size(); ++p) {
    if (next == order.size() || corners[order[next]].position != p) points.push_back({.position = p});
    for (; next < order.size() && corners[order[next]].position == p; ++next) {
      const Corner& corner = corners[order[next]];
      if (points.empty() || points.back() != corner) points.push_back(corner);
      point_of_corner[order[next]] = static_cast<uint32_t>(points.size() - 1);
    }
  }
  return points;
}

void add_attribute(proto::FormattedMesh& mesh, AttributeKind kind, uint32_t components,
                   const std::vector<Corner>& points, uint32_t Corner::*member, const Buffer<Vec3f>& listed) {
  Attribute& attribute = mesh.attributes.emplace_back();
  attribute.components = components;
  attribute.unit_length = kind == AttributeKind::normal;
  attribute.values.reserve(points.size() * components);
  for (const Corner& point : points) {
    const Vec3f value = point.*member == none ? Vec3f{} : listed[point.*member];
    const std::array<float, 3> numbers{value.x, value.y, value.z};
    attribute.values.insert(attribute.values.end(), numbers.begin(), numbers.begin() + components);
  }
  mesh.format.attributes.push_back({.kind = kind, .id = static_cast<uint32_t>(mesh.attributes.size())});
}

void add_groups(proto::FormattedMesh& mesh, const std::vector<Corner>& points) {
  Attribute& attribute = mesh.attributes.emplace_back();
  attribute.is_smoothing_group = true;
  for (const Corner& point : points) attribute.values.push_back(point.group);
  mesh.format.attributes.push_back({.kind = AttributeKind::generic,
                                    .type = proto::ValueType::int32,
                                    .id = static_cast<uint32_t>(mesh.attributes.size()),
                                    .name = proto::smoothing_group_name});
}

/// Makes the mesh of the lists, and moves their positions out. `face_of`, unless null, receives the face of each
/// triangle.
proto::FormattedMesh make_mesh(Lists& lists, std::vector<uint32_t>* face_of) {
  const bool textures = are_used(lists.corners, &Corner::texture, lists.textures, "texture coordinate (vt)");
  const bool normals = are_used(lists.corners, &Corner::normal, lists.normals, "normal (vn)");
  const bool groups = have_groups(lists.corners);
  proto::FormattedMesh mesh;
  mesh.triangles = triangulate(lists, face_of);
  const bool sound =
      std::ranges::all_of(lists.corners, [&](const Corner& c) { return c.position < lists.positions.size(); });
  if (!sound || (!textures && !normals && !groups)) {  // the caller reports indices out of range
    for (Triangle& triangle : mesh.triangles)
      for (uint32_t& corner : triangle) corner = lists.corners[corner].position;
    mesh.positions = std::move(lists.positions);
    return mesh;
  }
  std::vector<uint32_t> point_of_corner;
  const std::vector<Corner> points = make_points(lists, point_of_corner);
  for (Triangle& triangle : mesh.triangles)
    for (uint32_t& corner : triangle) corner = point_of_corner[corner];
  for (const Corner& point : points) mesh.positions.push_back(lists.positions[point.position]);
  const bool three = std::ranges::any_of(lists.textures, [](Vec3f t) { return t.z != 0; });
  if (textures) add_attribute(mesh, AttributeKind::tex_coord, three ? 3 : 2, points, &Corner::texture, lists.textures);
  if (normals) add_attribute(mesh, AttributeKind::normal, 3, points, &Corner::normal, lists.normals);
  if (groups) add_groups(mesh, points);
  return mesh;
}

}  // namespace

ObjFile parse_obj_file(std::string_view bytes) {
  bytes = skip_byte_order_mark(bytes);
  if (bytes.find('\0') != std::string_view::npos) throw ParseError("is not a text, as OBJ files are");
  Lists lists = parse_lists(bytes);
  ObjFile file;
  file.materials.libraries = std::move(lists.libraries);
  file.materials.names = std::move(lists.materials);
  if (file.materials.names.empty()) {
    file.mesh = make_mesh(lists, nullptr);
    return file;
  }
  std::vector<uint32_t>& of_triangle = file.materials.of_triangle;
  file.mesh = make_mesh(lists, &of_triangle);
  for (uint32_t& number : of_triangle) number = lists.material_of_face[number];
  return file;
}

proto::FormattedMesh parse_obj(std::string_view bytes) { return parse_obj_file(bytes).mesh; }

}  // namespace papilio::client
