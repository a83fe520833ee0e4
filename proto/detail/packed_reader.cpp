#include "proto/detail/packed_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

const std::string primitive_place = "meshes[0].primitives[0]";
const std::string detail_place = primitive_place + ".extensions." + gltf::detail_extension;

[[noreturn]] void refuse_scene(const std::string& what) {
  throw Problem(Code::mesh_unsupported,
                "The scene has " + what + ", so it is no packed model. Make one with papilio pack.");
}

/// Returns the only element of an array.
const Json& only(const Json& array, const char* what) {
  if (!array.is_array() || array.size() != 1) refuse_scene("other than one " + std::string(what));
  return array[0];
}

double number_member(const Json& of, const char* key, const std::string& where) {
  const Json* value = gltf::find_member(of, key, where);
  if (value == nullptr) refuse_document(where, "has no " + std::string(key));
  const double number = value->is_number() ? value->get<double>() : std::nan("");
  if (!std::isfinite(number)) refuse_document(where + "." + key, "must be a finite number");
  return number;
}

double distance_member(const Json& of, const char* key, const std::string& where) {
  const double number = number_member(of, key, where);
  if (number < 0) refuse_document(where + "." + key, "must not be negative");
  return number;
}

float step_member(const Json& of, const std::string& where) {
  const double number = number_member(of, "step", where);
  const auto step = static_cast<float>(number);  // the nearest
  if (!(step > 0 && step <= coordinate_limit)) refuse_document(where + ".step", "must be above 0, and at most 1e18");
  return step;
}

DetailReach reach_member(const Json& of, const std::string& where) {
  return {distance_member(of, "rms", where), distance_member(of, "largest", where)};
}

/// Reader of one file.
class PackedReader {
 public:
  PackedReader(std::string_view glb, const ReadOptions& options)
      : options_(options), document_(options.may_be_cut ? gltf::read_cut_document(glb) : gltf::read_document(glb)) {
    if (!document_.is_glb) throw Problem(Code::mesh_unsupported, "A packed model is a .glb file. Convert it to one.");
    find_primitive();
  }

  PackedModel read() {
    const Json& extension = *gltf::find_extension(*primitive_, gltf::detail_extension, primitive_place);
    require_version(extension);
    PackedModel model;
    model.base_reach = reach_member(extension, detail_place);
    const Json& levels = levels_of(extension);
    model.declared_levels = levels.size();
    const uint64_t faces = declared_faces();
    require_room(faces, std::min(options_.levels, levels.size()));
    read_base(faces, model);
    read_curves(extension, model);
    read_levels(levels, model);
    return model;
  }

 private:
  void find_primitive() {
    const Json& mesh = only(gltf::array_of(document_.json, "meshes"), "mesh");
    const Json* primitives = gltf::find_member(mesh, "primitives", "meshes[0]");
    if (primitives == nullptr) refuse_document("meshes[0]", "has no primitives");
    primitive_ = &only(*primitives, "primitive");
    if (gltf::find_extension(*primitive_, gltf::detail_extension, primitive_place) == nullptr)
      throw Problem(Code::mesh_unsupported, "The scene has no " + std::string(gltf::detail_extension) +
                                                ", so it is no packed model. Make one with papilio pack.");
    const Json& node = only(gltf::array_of(document_.json, "nodes"), "node");
    for (const char* key : {"matrix", "translation", "rotation", "scale", "skin", "extensions"})
      if (gltf::find_member(node, key, "nodes[0]") != nullptr) refuse_scene("a node with " + std::string(key));
    if (document_.buffers.size() != 1 || document_.buffers[0].place() != gltf::BufferPlace::binary_chunk)
      refuse_scene("other than one buffer, the binary chunk");
    for (const char* key : {"targets", "mode"})
      if (primitive_->contains(key)) refuse_scene("a primitive with " + std::string(key));
  }

  static void require_version(const Json& extension) {
    const uint64_t version = gltf::whole_number(extension, "version", detail_place);
    if (version != detail_version)
      throw Problem(Code::mesh_unsupported,
                    std::string(gltf::detail_extension) + " has version " + std::to_string(version) + "; version " +
                        std::to_string(detail_version) + " is supported. Update papilio, or pack the model again.");
  }

  static const Json& levels_of(const Json& extension) {
    const Json* levels = gltf::find_member(extension, "levels", detail_place);
    if (levels == nullptr || !levels->is_array()) refuse_document(detail_place, "has no array of levels");
    if (levels->size() > most_detail_levels)
      refuse_document(detail_place, "has " + std::to_string(levels->size()) + " levels; at most " +
                                        std::to_string(most_detail_levels) + " are allowed");
    return *levels;
  }

  /// Returns the faces that the accessor of the indices declares.
  [[nodiscard]] uint64_t declared_faces() const {
    const uint64_t corners = declared_count(gltf::index_member(*primitive_, "indices", primitive_place));
    if (corners % 3 != 0) refuse_document(primitive_place, "has indices of other than whole triangles");
    return corners / 3;
  }

  [[nodiscard]] uint64_t declared_count(std::optional<uint32_t> accessor) const {
    if (!accessor) refuse_document(primitive_place, "lacks an accessor of positions or indices");
    const Json& json = gltf::element_of(document_.json, "accessors", *accessor, primitive_place);
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

  /// Returns the bytes of a view, which begins at or after the end of the view before; nothing if the file was cut
  /// before its end.
  std::optional<std::string_view> bytes_of(const Json& of, const std::string& where) {
    const auto number = gltf::index_member(of, "bufferView", where);
    if (!number) return std::string_view();
    return bytes_of_view(*number, where);
  }
  std::optional<std::string_view> bytes_of_view(uint32_t number, const std::string& where) {
    const gltf::ViewRange range = gltf::view_range(document_, number, where);
    const std::string view = gltf::place("bufferViews", number);
    for (const char* key : {"byteStride", "extensions"})
      if (gltf::element_of(document_.json, "bufferViews", number, where).contains(key))
        refuse_document(view, "holds a stream and has " + std::string(key));
    if (range.offset < end_)
      refuse_document(view, "begins at byte " + std::to_string(range.offset) + ", before the end of " + before_ +
                                " at byte " + std::to_string(end_));
    end_ = range.offset + range.length;
    before_ = view;
    const std::string_view bytes = document_.buffers[0].bytes();
    if (end_ > bytes.size()) return std::nullopt;
    return bytes.substr(range.offset, range.length);
  }

  void read_base(uint64_t faces, PackedModel& model) {
    const Json* attributes = gltf::find_member(*primitive_, "attributes", primitive_place);
    const Json* draco = gltf::find_extension(*primitive_, gltf::draco_extension, primitive_place);
    if (attributes == nullptr || draco == nullptr || !attributes->is_object())
      refuse_document(primitive_place, "has no base compressed by " + std::string(gltf::draco_extension));
    has_texcoords_ = attributes->contains("TEXCOORD_0");
    if (attributes->size() != (has_texcoords_ ? 2 : 1)) refuse_scene("other attributes than POSITION and TEXCOORD_0");
    const uint64_t vertices = declared_count(gltf::index_member(*attributes, "POSITION", primitive_place));
    const std::optional<std::string_view> stream = bytes_of(*draco, primitive_place);
    if (!stream)
      throw Problem(Code::mesh_not_gltf,
                    "The file is cut inside its base, so no level can be read. Provide more of it.");
    FormattedMesh base = read_draco(*stream, options_.limits);
    if (base.positions.size() != vertices || base.triangles.size() != faces)
      refuse_document(primitive_place, "declares other counts than its Draco stream has");
    if (base.format.attributes != (has_texcoords_ ? one_texcoord(base) : std::vector<AttributeFormat>{}))
      refuse_scene("a base with other attributes than it declares");
    edges_ = edges_of(base);
    model.base_bytes = stream->size();
    model.base.triangles = std::move(base);
  }

  /// Returns the format of a base's attributes if they are texture coordinates as packed models have them.
  static std::vector<AttributeFormat> one_texcoord(const FormattedMesh& base) {
    if (base.attributes.size() != 1 || base.attributes[0].components != 2) refuse_scene("no texture coordinates");
    std::vector<AttributeFormat> expected = base_format(base).attributes;
    expected[0].id = base.format.attributes[0].id;
    return expected;
  }

  /// Returns the edges of a base. Refuses one that is not manifold.
  static uint64_t edges_of(const TriangleMesh& base) {
    BuildReport found;
    const Mesh mesh = translate_errors([&] { return build_mesh(base, &found); });
    const uint32_t welded = base.attributes.empty() ? found.welded_points : 0;  // at seams points are
    const uint32_t changed = welded + found.isolated_points + found.degenerate_faces + found.repeated_faces;
    if (changed + found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices > 0)
      throw Problem(Code::mesh_unusable, "The base is not a manifold surface. Pack the original again.");
    return mesh.topology.edge_count();
  }

  void read_curves(const Json& extension, PackedModel& model) {
    const auto number = gltf::index_member(extension, "curves", detail_place);
    if (!number) return;
    const std::optional<std::string_view> bytes = bytes_of_view(*number, detail_place);
    if (!bytes)
      throw Problem(Code::mesh_not_gltf,
                    "The file is cut inside the curves of its base, so no level can be read. Provide more of it.");
    model.base.curves.assign(bytes->begin(), bytes->end());
  }

  void read_levels(const Json& levels, PackedModel& model) {
    uint64_t faces = model.base.triangles.triangles.size();
    uint64_t edges = edges_;
    for (size_t l = 0; l < levels.size(); ++l) {
      const std::string where = detail_place + ".levels[" + std::to_string(l) + "]";
      PackedLevel level{.stream = {step_member(levels[l], where), {}},
                        .reach = reach_member(levels[l], where),
                        .vertices = gltf::whole_number(levels[l], "vertices", where),
                        .faces = 4 * faces};
      if (level.vertices != edges)
        refuse_document(where + ".vertices",
                        "is " + std::to_string(level.vertices) + ", and the base gives " + std::to_string(edges));
      edges = 2 * edges + 3 * faces;
      faces *= 4;
      const std::optional<std::string_view> bytes = bytes_of(levels[l], where);
      if (bytes) level.stream.bytes.assign(bytes->begin(), bytes->end());
      const bool is_whole = read_texcoords(levels[l], where, level.stream.texcoords) && bytes.has_value();
      if (!is_whole || l != model.levels.size() || l >= options_.levels) continue;
      model.levels.push_back(std::move(level));
    }
  }

  /// Reads the texture coordinates of a level. Returns whether the file was not cut before their end.
  bool read_texcoords(const Json& level, const std::string& level_place, TexcoordStream& stream) {
    const Json* texcoords = gltf::find_member(level, "texcoords", level_place);
    if (texcoords == nullptr) return true;
    const std::string where = level_place + ".texcoords";
    if (!has_texcoords_) refuse_document(where, "is there, and the base has no TEXCOORD_0");
    stream.step = step_member(*texcoords, where);
    const std::optional<std::string_view> bytes = bytes_of(*texcoords, where);
    if (bytes) stream.bytes.assign(bytes->begin(), bytes->end());
    return bytes.has_value();
  }

  const ReadOptions& options_;
  gltf::Document document_;
  const Json* primitive_ = nullptr;
  bool has_texcoords_ = false;               ///< of the base
  uint64_t edges_ = 0;                       ///< of the base
  uint64_t end_ = 0;                         ///< of the last view, in the binary chunk
  std::string before_ = "the binary chunk";  ///< name of the last view
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
