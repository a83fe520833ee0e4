#include "proto/detail/packed_writer.h"

#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>

#include "proto/detail/level_table.h"
#include "proto/detail/mesh_parts.h"
#include "proto/detail/packed_model.h"
#include "proto/detail/packed_normals.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/gltf/accessor.h"
#include "proto/gltf/container.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/json.h"
#include "proto/gltf/material_writer.h"
#include "proto/text.h"

namespace papilio::proto::detail {
namespace {

using gltf::ComponentType;
using gltf::Json;

/// Returns the number with the fewest digits whose nearest float is `value`.
double shortest(float value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  const std::optional<double> found = parse_number({text.data(), error == std::errc() ? end : text.data()});
  return found && static_cast<float>(*found) == value ? *found : static_cast<double>(value);
}

Json box_corner(Vec3f p) { return {shortest(p.x), shortest(p.y), shortest(p.z)}; }

/// Scene of one mesh, and its binary chunk.
struct Scene {  // NOLINT(bugprone-exception-escape): moving JSON cannot throw
  Json json;
  std::string binary;

  /// Appends a view; returns its number.
  size_t add_view(std::string_view bytes) {
    Json& views = json["bufferViews"];
    Json view{{"buffer", 0}};
    if (!binary.empty()) view["byteOffset"] = binary.size();
    view["byteLength"] = bytes.size();
    views.push_back(std::move(view));
    binary += bytes;
    return views.size() - 1;
  }
  Json& primitives() { return json["meshes"][0]["primitives"]; }
  /// Adds an accessor; returns its number.
  size_t add_accessor(Json accessor) {
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }
  /// Adds a primitive with its Draco stream.
  void add_primitive(const TriangleMesh& mesh, std::string_view stream) {
    const Box box = bounding_box(mesh.positions);
    const auto index =
        mesh.positions.size() <= gltf::most_vertices_of_16_bits ? ComponentType::uint16 : ComponentType::uint32;
    constexpr auto number = static_cast<uint32_t>(ComponentType::float32);
    Json attributes{{"POSITION", add_accessor({{"componentType", number},
                                               {"count", mesh.positions.size()},
                                               {"type", "VEC3"},
                                               {"min", box_corner(box.min)},
                                               {"max", box_corner(box.max)}})}};
    const size_t indices = add_accessor(
        {{"componentType", static_cast<uint32_t>(index)}, {"count", 3 * mesh.triangles.size()}, {"type", "SCALAR"}});
    Json extension{{"bufferView", add_view(stream)}, {"attributes", {{"POSITION", 0}}}};
    for (const AttributeFormat& attribute : base_format(mesh.attributes).attributes) {
      const bool is_texcoord = attribute.kind == AttributeKind::tex_coord;
      const bool is_colour = attribute.kind == AttributeKind::color;
      const char* const semantic = is_texcoord ? "TEXCOORD_0" : is_colour ? "COLOR_0" : "NORMAL";
      extension["attributes"][semantic] = attribute.id;
      Json accessor{{"componentType", is_colour ? static_cast<uint32_t>(ComponentType::uint8) : number},
                    {"count", mesh.positions.size()},
                    {"type", is_texcoord ? "VEC2" : "VEC3"}};
      if (is_colour) accessor["normalized"] = true;
      attributes[semantic] = add_accessor(std::move(accessor));
    }
    primitives().push_back({{"attributes", std::move(attributes)},
                            {"indices", indices},
                            {"extensions", {{gltf::draco_extension, std::move(extension)}}}});
  }
  /// Adds the materials of these parts' primitives. Their views come last.
  void add_materials(const gltf::Materials& materials, const std::vector<MeshPart>& parts) {
    if (materials.empty()) return;
    gltf::add_materials(json, materials, primitives()[0]["attributes"].contains("TEXCOORD_0"),
                        [this](std::string_view bytes) { return add_view(bytes); });
    if (parts.size() == 1) primitives()[0]["material"] = 0;
    for (size_t p = 0; p < parts.size(); ++p)
      if (parts[p].number > 0) primitives()[p]["material"] = static_cast<uint32_t>(parts[p].number) - 1;
  }
  [[nodiscard]] std::string write() && {
    json["buffers"][0]["byteLength"] = binary.size();
    std::vector<gltf::Piece> pieces;
    pieces.push_back({{}, std::move(binary)});
    return gltf::write_glb(json.dump(), std::move(pieces), {});
  }
};

/// Returns a scene with a primitive for each part of a mesh.
Scene scene_of(const std::vector<MeshPart>& parts, const std::vector<std::string>& streams) {
  if (parts.size() != streams.size()) throw std::invalid_argument("scene_of: parts and streams disagree");
  Scene scene;
  scene.json = {{"asset", {{"version", "2.0"}, {"generator", "papilio"}}},
                {"extensionsUsed", {gltf::draco_extension}},
                {"extensionsRequired", {gltf::draco_extension}},
                {"scene", 0},
                {"scenes", Json::array({{{"nodes", {0}}}})},
                {"nodes", Json::array({{{"mesh", 0}}})},
                {"meshes", Json::array({{{"primitives", Json::array()}}})},
                {"accessors", Json::array()},
                {"bufferViews", Json::array()},
                {"buffers", Json::array({Json::object()})}};
  for (size_t p = 0; p < parts.size(); ++p) scene.add_primitive(parts[p].triangles, streams[p]);
  return scene;
}

LevelTable table_of(const EncodedDetail& detail) {
  LevelTable table{.edges = build_mesh(detail.base.triangles).topology.edge_count(),
                   .curve_bytes = static_cast<uint32_t>(detail.base.curves.size()),
                   .base_reach = detail.reach[0],
                   .rows = {}};
  for (size_t l = 0; l < detail.levels.size(); ++l) {
    const DetailStream& stream = detail.levels[l];
    table.rows.push_back({.step = stream.step,
                          .reach = detail.reach[l + 1],
                          .bytes = static_cast<uint32_t>(stream.bytes.size()),
                          .texcoord_step = stream.texcoords.step,
                          .texcoord_bytes = static_cast<uint32_t>(stream.texcoords.bytes.size()),
                          .pieces = stream.pieces});
    table.has_texcoords = table.has_texcoords || stream.texcoords.step > 0;
    table.has_pieces = table.has_pieces || !stream.pieces.empty();
  }
  return table;
}

/// Returns the view of a packed model's table and streams.
std::string streams_of(const EncodedDetail& detail) {
  std::string out = write_table(table_of(detail));
  out.append(detail.base.curves.begin(), detail.base.curves.end());
  for (const DetailStream& stream : detail.levels) {
    auto residuals = stream.bytes.begin();
    auto texcoords = stream.texcoords.bytes.begin();
    for (const DetailPiece& piece : stream.pieces) {
      out.append(residuals, residuals + piece.bytes);
      out.append(texcoords, texcoords + piece.texcoord_bytes);
      residuals += piece.bytes;
      texcoords += piece.texcoord_bytes;
    }
    out.append(residuals, stream.bytes.end());  // rest, or all of a level without pieces
    out.append(texcoords, stream.texcoords.bytes.end());
  }
  return out;
}

}  // namespace

std::string write_packed(const EncodedDetail& detail, const std::vector<std::string>& base_streams,
                         const gltf::Materials& materials) {
  if (detail.reach.size() != detail.levels.size() + 1 || detail.levels.size() > most_detail_levels)
    throw std::invalid_argument("write_packed: levels and distances disagree");
  const std::vector<MeshPart> parts = split_parts(detail.base.triangles);
  Scene scene = scene_of(parts, base_streams);
  scene.json["extensionsUsed"].push_back(gltf::detail_extension);
  const size_t view = scene.add_view(streams_of(detail));
  Json extension{{"version", detail_version}, {"bufferView", view}};
  if (detail.normals != NormalStyle::absent) extension["normals"] = name_of(detail.normals);
  scene.primitives()[0]["extensions"][gltf::detail_extension] = std::move(extension);
  scene.add_materials(materials, parts);
  return std::move(scene).write();
}

std::string write_plain(const TriangleMesh& decoded, const std::vector<std::string>& streams, NormalStyle normals,
                        const gltf::Materials& materials) {
  const std::vector<MeshPart> parts = split_parts(decoded);
  Scene scene = scene_of(parts, streams);
  if (normals != NormalStyle::absent) scene.primitives()[0]["extras"]["normals"] = name_of(normals);
  scene.add_materials(materials, parts);
  return std::move(scene).write();
}

}  // namespace papilio::proto::detail
