#include "proto/detail/packed_reader.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "proto/detail/level_table.h"
#include "proto/detail/mesh_parts.h"
#include "proto/detail/packed_normals.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/draco_reader.h"
#include "proto/error_translation.h"
#include "proto/gltf/document.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/views.h"
#include "proto/problem.h"

namespace papilio::proto::detail {
namespace {

using gltf::Json;
using gltf::refuse_document;

std::string primitive_place(size_t number) { return "meshes[0]." + gltf::place("primitives", number); }

const std::string detail_place = primitive_place(0) + ".extensions." + gltf::detail_extension;

[[noreturn]] void refuse_scene(const std::string& what) {
  throw Problem(Code::mesh_unsupported,
                "The scene has " + what + ", so it is no packed model. Make one with papilio pack.");
}

/// Returns the element of an array that must have one.
const Json& only(const Json& array, const char* what) {
  if (!array.is_array() || array.size() != 1) refuse_scene("other than one " + std::string(what));
  return array[0];
}

[[noreturn]] void refuse_cut(const std::string& where) {
  throw Problem(Code::mesh_not_gltf,
                "The file is cut inside " + where + ", so no level can be read. Provide more of it.");
}

NormalStyle normals_member(const Json& extension) {
  const Json* name = gltf::find_member(extension, "normals", detail_place);
  if (name == nullptr) return NormalStyle::absent;
  const auto style = name->is_string() ? normal_style_named(name->get<std::string>()) : std::nullopt;
  if (!style) refuse_document(detail_place + ".normals", "must be \"smooth\", \"creased\" or \"faceted\"");
  return *style;
}

/// Numbers materials in the order of their first use.
class MaterialNumbers {
 public:
  /// Returns the part number (mesh_parts.h) of a primitive.
  [[nodiscard]] double part_of(const Json& primitive, const std::string& place) {
    const auto material = gltf::index_member(primitive, "material", place);
    if (!material) return 0;
    return number_.try_emplace(*material, static_cast<double>(number_.size() + 1)).first->second;
  }

 private:
  std::map<uint32_t, double> number_;
};

/// Reader of one file.
class PackedReader {
 public:
  PackedReader(std::string_view glb, const ReadOptions& options)
      : options_(options), document_(options.may_be_cut ? gltf::read_cut_document(glb) : gltf::read_document(glb)) {
    if (!document_.is_glb) throw Problem(Code::mesh_unsupported, "A packed model is a .glb file. Convert it to one.");
    find_primitives();
  }

  PackedModel read() {
    const Json& extension = *gltf::find_extension(primitives()[0], gltf::detail_extension, primitive_place(0));
    require_version(extension);
    std::vector<std::string_view> base;
    for (size_t p = 0; p < primitives().size(); ++p) base.push_back(base_stream(p));
    const View detail = view_at(gltf::index_member(extension, "bufferView", detail_place), detail_place);
    const LevelTable table = table_of(detail);
    PackedModel model;
    model.base_reach = table.base_reach;
    model.declared_levels = table.rows.size();
    const uint64_t faces = declared_faces();
    require_room(faces, std::min(options_.levels, table.rows.size()));
    for (const LevelRow& row : table.rows)
      if (row.pieces.size() > faces) refuse_document("the table of levels", "has more pieces than the base has faces");
    model.normals = normals_member(extension);
    read_base(base, table, model);
    read_streams(table, detail.bytes.substr(table.size()), model);
    return model;
  }

 private:
  [[nodiscard]] const Json& primitives() const { return *primitives_; }

  void find_primitives() {
    const Json& mesh = only(gltf::array_of(document_.json, "meshes"), "mesh");
    primitives_ = gltf::find_member(mesh, "primitives", "meshes[0]");
    if (primitives_ == nullptr || !primitives_->is_array() || primitives_->empty())
      refuse_document("meshes[0]", "has no primitives");
    if (gltf::find_extension(primitives()[0], gltf::detail_extension, primitive_place(0)) == nullptr)
      throw Problem(Code::mesh_unsupported, "The scene has no " + std::string(gltf::detail_extension) +
                                                ", so it is no packed model. Make one with papilio pack.");
    const Json& node = only(gltf::array_of(document_.json, "nodes"), "node");
    for (const char* key : {"matrix", "translation", "rotation", "scale", "skin", "extensions"})
      if (gltf::find_member(node, key, "nodes[0]") != nullptr) refuse_scene("a node with " + std::string(key));
    if (document_.buffers.size() != 1 || document_.buffers[0].place() != gltf::BufferPlace::binary_chunk)
      refuse_scene("other than one buffer, the binary chunk");
    for (size_t p = 0; p < primitives().size(); ++p) {
      for (const char* key : {"targets", "mode"})
        if (primitives()[p].contains(key)) refuse_scene("a primitive with " + std::string(key));
      if (p > 0 && gltf::find_extension(primitives()[p], gltf::detail_extension, primitive_place(p)) != nullptr)
        refuse_scene("several primitives with " + std::string(gltf::detail_extension));
    }
  }

  static void require_version(const Json& extension) {
    const uint64_t version = gltf::whole_number(extension, "version", detail_place);
    if (version != detail_version)
      throw Problem(Code::mesh_unsupported,
                    std::string(gltf::detail_extension) + " has version " + std::to_string(version) + "; version " +
                        std::to_string(detail_version) + " is supported. Update papilio, or pack the model again.");
  }

  /// Returns the faces that the accessors of the indices declare.
  [[nodiscard]] uint64_t declared_faces() const {
    uint64_t faces = 0;
    for (size_t p = 0; p < primitives().size(); ++p) faces += declared_faces(p);
    return faces;
  }
  [[nodiscard]] uint64_t declared_faces(size_t primitive) const {
    const std::string place = primitive_place(primitive);
    const uint64_t corners = declared_count(gltf::index_member(primitives()[primitive], "indices", place), place);
    if (corners % 3 != 0) refuse_document(place, "has indices of other than whole triangles");
    return corners / 3;
  }

  [[nodiscard]] uint64_t declared_count(std::optional<uint32_t> accessor, const std::string& place) const {
    if (!accessor) refuse_document(place, "lacks an accessor of positions or indices");
    const Json& json = gltf::element_of(document_.json, "accessors", *accessor, place);
    return gltf::whole_number(json, "count", gltf::place("accessors", *accessor));
  }

  void require_room(uint64_t faces, size_t levels) const {
    const Limits& limits = options_.limits;
    if (faces > limits.max_input_faces)
      throw Problem(Code::mesh_too_large, "The base has " + std::to_string(faces) + " faces; the limit is " +
                                              std::to_string(limits.max_input_faces) + ".");
    if (faces > limits.max_output_faces >> (2 * levels))
      throw Problem(Code::result_too_large, "The base of " + std::to_string(faces) + " faces has more than " +
                                                std::to_string(limits.max_output_faces) + " at level " +
                                                std::to_string(levels) + ", the limit. Request fewer levels.");
  }

  /// View with its bytes, which may be fewer in a cut file.
  struct View {
    std::string place;
    uint64_t length = 0;
    std::string_view bytes;
  };

  /// Returns a view, which must begin at or after the end of the view before.
  View view_at(std::optional<uint32_t> number, const std::string& where) {
    if (!number) refuse_document(where, "has no bufferView");
    const gltf::ViewRange range = gltf::view_range(document_, *number, where);
    View view{.place = gltf::place("bufferViews", *number), .length = range.length, .bytes = {}};
    for (const char* key : {"byteStride", "extensions"})
      if (gltf::element_of(document_.json, "bufferViews", *number, where).contains(key))
        refuse_document(view.place, "holds a stream and has " + std::string(key));
    if (range.offset < end_)
      refuse_document(view.place, "begins at byte " + std::to_string(range.offset) +
                                      ", before the end of the base at byte " + std::to_string(end_));
    end_ = range.offset + range.length;
    const std::string_view bytes = document_.buffers[0].bytes();
    view.bytes = bytes.substr(std::min<uint64_t>(range.offset, bytes.size()), range.length);
    return view;
  }

  /// Returns the Draco stream of a primitive of the base.
  std::string_view base_stream(size_t primitive) {
    const std::string place = primitive_place(primitive);
    const Json* draco = gltf::find_extension(primitives()[primitive], gltf::draco_extension, place);
    if (draco == nullptr) refuse_document(place, "has no base compressed by " + std::string(gltf::draco_extension));
    const View view = view_at(gltf::index_member(*draco, "bufferView", place), place);
    if (view.bytes.size() < view.length) refuse_cut("its base");
    return view.bytes;
  }

  /// Returns the table at the begin of a view, which it and its streams fill.
  static LevelTable table_of(const View& view) {
    if (view.length < least_table_bytes) refuse_document(view.place, "is too short for a table of levels");
    const auto first = [&](uint64_t size) {
      if (view.length < size) refuse_document(view.place, "is too short for its table of levels");
      if (view.bytes.size() < size) refuse_cut("the table of its levels");
      return view.bytes.substr(0, size);
    };
    LevelTable table = read_table(first(size_of_table(first(size_of_rows(first(least_table_bytes))))));
    if (view.length != table.total())
      refuse_document(view.place, "has " + std::to_string(view.length) + " bytes, and its table declares " +
                                      std::to_string(table.total()));
    return table;
  }

  void read_base(const std::vector<std::string_view>& streams, const LevelTable& table, PackedModel& model) const {
    std::vector<MeshPart> parts;
    MaterialNumbers numbers;
    for (size_t p = 0; p < streams.size(); ++p) {
      model.base_bytes += streams[p].size();
      parts.push_back({numbers.part_of(primitives()[p], primitive_place(p)), read_primitive(streams[p], p, table)});
    }
    model.base.triangles = join_parts(std::move(parts));
    if (const uint64_t edges = edges_of(model.base.triangles); table.edges != edges)
      refuse_document("the table of levels",
                      "declares " + std::to_string(table.edges) + " edges, and the base has " + std::to_string(edges));
  }

  [[nodiscard]] TriangleMesh read_primitive(std::string_view stream, size_t primitive, const LevelTable& table) const {
    const std::string place = primitive_place(primitive);
    const std::vector<std::string> values = values_of(primitives()[0], primitive_place(0));
    if (values_of(primitives()[primitive], place) != values) refuse_scene("primitives of different attributes");
    if (table.has_texcoords && values.empty())
      refuse_document(
          "the table of levels",
          "has residuals of texture coordinates or colours, and the base has neither TEXCOORD_0 nor COLOR_0");
    const Json& attributes = *gltf::find_member(primitives()[primitive], "attributes", place);
    const uint64_t vertices = declared_count(gltf::index_member(attributes, "POSITION", place), place);
    FormattedMesh part = read_draco(stream, options_.limits);
    if (part.positions.size() != vertices || part.triangles.size() != declared_faces(primitive))
      refuse_document(place, "declares other counts than its Draco stream has");
    require_values(part, values);
    return part;
  }

  /// Returns the attributes of a primitive besides its positions, in the order of a base's attributes. Refuses others.
  static std::vector<std::string> values_of(const Json& primitive, const std::string& place) {
    const Json* attributes = gltf::find_member(primitive, "attributes", place);
    if (attributes == nullptr || !attributes->is_object()) refuse_document(place, "has no attributes");
    std::vector<std::string> values;
    for (const char* name : {"TEXCOORD_0", "COLOR_0"})
      if (attributes->contains(name)) values.emplace_back(name);
    if (attributes->size() != 1 + values.size()) refuse_scene("other attributes than POSITION, TEXCOORD_0 and COLOR_0");
    return values;
  }

  /// Refuses a part of the base unless its attributes are `values`, in the formats of packed models.
  static void require_values(const FormattedMesh& part, const std::vector<std::string>& values) {
    bool is_sound = part.attributes.size() == values.size();
    for (size_t a = 0; is_sound && a < values.size(); ++a)
      is_sound = part.attributes[a].components == (values[a] == "COLOR_0" ? 3 : 2);
    if (!is_sound) refuse_scene("a base with other attributes than it declares");
    std::vector<AttributeFormat> expected = base_format(part.attributes).attributes;
    for (size_t a = 0; a < values.size(); ++a) expected[a].id = part.format.attributes[a].id;
    if (part.format.attributes != expected)
      refuse_scene("a base whose attributes have other formats than those of papilio");
  }

  /// Returns the edges of a base. Refuses one that is not manifold.
  static uint64_t edges_of(const TriangleMesh& base) {
    BuildReport found;
    const Mesh mesh = translate_errors([&] { return build_mesh(base, &found); });
    const uint32_t changed = found.isolated_points + found.degenerate_faces + found.repeated_faces;
    if (changed + found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices > 0)
      throw Problem(Code::mesh_unusable, "The base is not a manifold surface. Pack the original again.");
    return mesh.topology.edge_count();
  }

  /// Reads the curves and the levels of streams, and of a cut level its whole pieces.
  void read_streams(const LevelTable& table, std::string_view streams, PackedModel& model) const {
    if (streams.size() < table.curve_bytes) refuse_cut("the curves of its base");
    model.base.curves.assign(streams.begin(), streams.begin() + table.curve_bytes);
    streams.remove_prefix(table.curve_bytes);
    uint64_t faces = model.base.triangles.triangles.size();
    uint64_t edges = table.edges;
    for (size_t l = 0; l < std::min(options_.levels, table.rows.size()); ++l) {
      PackedLevel level = read_level(table.rows[l], streams);
      if (level.missing_pieces == std::max<size_t>(1, level.stream.pieces.size())) break;
      const bool is_whole = level.missing_pieces == 0;
      level.reach = is_whole ? table.rows[l].reach : reach_of(model);
      level.vertices = edges;
      level.faces = 4 * faces;
      model.levels.push_back(std::move(level));
      if (!is_whole) break;
      edges = 2 * edges + 3 * faces;
      faces *= 4;
    }
  }

  /// Consumes the whole pieces at the begin of the streams.
  static PackedLevel read_level(const LevelRow& row, std::string_view& streams) {
    PackedLevel level;
    level.stream.step = row.step;
    level.stream.texcoords.step = row.texcoord_step;
    const auto take = [&](uint32_t bytes, std::vector<uint8_t>& to) {
      to.insert(to.end(), streams.begin(), streams.begin() + bytes);
      streams.remove_prefix(bytes);
    };
    std::vector<DetailPiece> pieces = row.pieces;
    if (pieces.empty()) pieces.push_back({.bytes = row.bytes, .texcoord_bytes = row.texcoord_bytes});
    for (DetailPiece& piece : pieces) {
      if (level.missing_pieces > 0 || uint64_t{piece.bytes} + piece.texcoord_bytes > streams.size()) {
        ++level.missing_pieces;
        piece.is_missing = true;
        piece.bytes = piece.texcoord_bytes = 0;
        continue;
      }
      take(piece.bytes, level.stream.bytes);
      take(piece.texcoord_bytes, level.stream.texcoords.bytes);
    }
    if (!row.pieces.empty()) level.stream.pieces = std::move(pieces);
    return level;
  }

  const ReadOptions& options_;
  gltf::Document document_;
  const Json* primitives_ = nullptr;
  uint64_t end_ = 0;  ///< end of the last view in the binary chunk
};

}  // namespace

bool is_packed(std::string_view glb) {
  try {
    const Json json = gltf::parse_document(gltf::read_glb(glb, gltf::Cut::in_binary_chunk).json);
    const Json& meshes = gltf::array_of(json, "meshes");
    return std::ranges::any_of(meshes, [](const Json& mesh) {
      const Json* primitives = gltf::find_member(mesh, "primitives", "a mesh");
      return primitives != nullptr && std::ranges::any_of(*primitives, [](const Json& primitive) {
               return gltf::find_extension(primitive, gltf::detail_extension, "a primitive") != nullptr;
             });
    });
  } catch (const Problem&) {
    return false;
  }
}

PackedModel read_packed(std::string_view glb, const ReadOptions& options) { return PackedReader(glb, options).read(); }

}  // namespace papilio::proto::detail
