#include "proto/draco_writer.h"

#include <draco/compression/expert_encode.h>
#include <draco/core/draco_version.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/normals.h"
#include "proto/draco_attributes.h"
#include "proto/edgebreaker/writer.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

constexpr int normal_bits = 10;
// A quarter of a texel of a texture of 4096; at 12 bits a whole one, and the picture would swim where faces are small.
constexpr int texture_bits = 14;
constexpr int value_bits = 16;  // of values whose meaning is not known
constexpr double largest_integer = 1 << 20;
constexpr double smallest_range = 1e-30;  // below, Draco's steps a unit overflow

std::string exact_text(float value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// What ExpertEncoder::SetAttributeExplicitQuantization sets, but to the bit: that writes numbers with six decimals, in
/// which the box of a small mesh is lost.
draco::Options explicit_quantization(const std::vector<float>& origin, float range, int bits) {
  std::string text;
  for (float component : origin) text += (text.empty() ? "" : " ") + exact_text(component);
  draco::Options options;
  options.SetInt("quantization_bits", bits);
  options.SetString("quantization_origin", text);
  options.SetString("quantization_range", exact_text(range));
  return options;
}

/// Whether Draco's octahedral coding takes it.
bool is_unit_normal(const Attribute& attribute, const AttributeFormat& format) {
  return format.kind == AttributeKind::normal && format.type == ValueType::float32 && attribute.components == 3;
}

/// A mesh on its way to Draco.
class Encoding {
 public:
  /// With `attributes` points are what the faces name, else vertices.
  Encoding(const Mesh& mesh, bool attributes) : mesh_(mesh), encoder_(out_) {
    if (attributes) points_.emplace(mesh);
    const Array<uint32_t>& corner = attributes ? mesh.attributes.point : mesh.topology.origin;
    out_.set_num_points(attributes ? mesh.attributes.point_count : mesh.topology.vertex_count);
    out_.SetNumFaces(mesh.topology.face_count());
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f)
      out_.SetFace(draco::FaceIndex(f), {draco::PointIndex(corner[3 * f]), draco::PointIndex(corner[3 * f + 1]),
                                         draco::PointIndex(corner[3 * f + 2])});
    add_vertices(draco::GeometryAttribute::POSITION, mesh.positions);
  }

  int add_vertices(draco::GeometryAttribute::Type type, const Array<Vec3f>& values) {
    return add_vertex_attribute(out_, type, values, points_ ? &*points_ : nullptr);
  }

  int add(size_t number, const AttributeFormat& format) {
    const Attribute& attribute = mesh_.attributes.attributes[number];
    const int added = add_point_attribute(out_, attribute, format, *points_);
    if (is_too_large(attribute, format)) {
      options().SetAttributeInt(added, "prediction_scheme", draco::PREDICTION_NONE);
      encoder_.SetUseBuiltInAttributeCompression(false);  // of all attributes, there is no other way
    } else if (format.kind == AttributeKind::normal && !is_unit_normal(attribute, format)) {
      // Below speed 4 Draco predicts normals as if they were octahedral: integers that are not change, or it writes
      // past the end of its memory.
      options().SetAttributeInt(added, "prediction_scheme", draco::PREDICTION_DIFFERENCE);
    }
    return added;
  }

  [[nodiscard]] draco::EncoderOptions& options() { return encoder_.options(); }
  void set_unique_id(int number, uint32_t id) { out_.attribute(number)->set_unique_id(id); }

  std::string run() {
    // Named, since the automatic choice is sequential at speed 10: eleven times the bytes.
    encoder_.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    // Above speed 5 Draco would cut the surface open at seams, and write their positions twice.
    if (points_) options().SetGlobalBool("split_mesh_on_seams", false);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder_.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error("Draco's encoder refuses the mesh: " + status.error_msg_string());
    return {buffer.data(), buffer.size()};
  }

 private:
  /// Draco's entropy coder counts symbols in a table as long as the largest, and crashes where predictions from values
  /// of 31 bits overflow.
  static bool is_too_large(const Attribute& attribute, const AttributeFormat& format) {
    if (format.type != ValueType::int32 && format.type != ValueType::uint32) return false;
    const auto [low, high] = std::ranges::minmax(attribute.values);
    return std::max(-low, high) > largest_integer;
  }

  const Mesh& mesh_;
  draco::Mesh out_;
  draco::ExpertEncoder encoder_;
  std::optional<VertexPoints> points_;
};

AttributeEncoding::Grid grid_of(const Attribute& attribute) {
  AttributeEncoding::Grid grid;
  double range = 0;
  for (uint32_t i = 0; i < attribute.components; ++i) {
    double low = attribute.values[i];
    double high = low;
    for (size_t k = i; k < attribute.values.size(); k += attribute.components) {
      low = std::min(low, attribute.values[k]);
      high = std::max(high, attribute.values[k]);
    }
    grid.origin.push_back(static_cast<float>(low));
    range = std::max(range, high - low);
  }
  if (range < smallest_range) range = 1;  // all values are the origin
  if (range < static_cast<double>(std::numeric_limits<float>::max())) grid.range = static_cast<float>(range);
  return grid;
}

void set_quantization(Encoding& encoding, int number, const Attribute& attribute, const AttributeFormat& format,
                      const AttributeEncoding::Grid& grid) {
  if (format.type != ValueType::float32) return;
  if (is_unit_normal(attribute, format)) {
    encoding.options().SetAttributeInt(number, "quantization_bits", normal_bits);
  } else if (format.kind != AttributeKind::normal && grid.range > 0) {
    const int bits = format.kind == AttributeKind::tex_coord ? texture_bits : value_bits;
    encoding.options().SetAttributeOptions(number, explicit_quantization(grid.origin, grid.range, bits));
  }
}

/// Attributes to be written: all but the mesh's own normals where new ones replace them.
std::vector<size_t> choose_attributes(const MeshFormat& format, bool new_normals) {
  std::vector<size_t> chosen;
  for (size_t a = 0; a < format.attributes.size(); ++a)
    if (!new_normals || format.attributes[a].kind != AttributeKind::normal) chosen.push_back(a);
  return chosen;
}

/// The id of the normals that are replaced, or the lowest that is free.
uint32_t id_for_normals(const MeshFormat& format) {
  const auto& attributes = format.attributes;
  const auto own = std::ranges::find(attributes, AttributeKind::normal, &AttributeFormat::kind);
  if (own != attributes.end()) return own->id;
  uint32_t id = 0;
  while (id == format.position_id || std::ranges::count(attributes, id, &AttributeFormat::id) > 0) ++id;
  return id;
}

}  // namespace

QuantizationBox quantization_box(const Array<Vec3f>& coarse) {
  const Box box = bounding_box(coarse);
  const Vec3d low = to_double(box.min);
  const Vec3d size = to_double(box.max) - low;
  const double range = 1.25 * std::max({size.x, size.y, size.z});
  if (range < smallest_range)
    throw Problem(Code::mesh_unusable, "The mesh is smaller than 1e-30 across, too small to be encoded. Scale it up.");
  const Vec3d centre = low + 0.5 * size;
  return {to_float(centre - 0.5 * Vec3d{range, range, range}), static_cast<float>(range)};
}

AttributeEncoding attribute_encoding(const Mesh& coarse, MeshFormat format) {
  AttributeEncoding encoding{std::move(format), {}};
  for (const Attribute& attribute : coarse.attributes.attributes) encoding.grids.push_back(grid_of(attribute));
  return encoding;
}

std::string write_draco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                        const AttributeEncoding& attributes, bool* by_libdraco) {
  std::optional<std::string> written;
  if (attributes.format.attributes.empty())
    written = edgebreaker::write(mesh, box, options, attributes.format.position_id);
  if (by_libdraco != nullptr) *by_libdraco = !written;
  return written ? std::move(*written) : write_with_libdraco(mesh, box, options, attributes);
}

std::string write_with_libdraco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                const AttributeEncoding& attributes) {
  const MeshFormat& format = attributes.format;
  const std::vector<size_t> chosen = choose_attributes(format, options.normals);
  Encoding encoding(mesh, !chosen.empty());
  encoding.options().SetSpeed(options.speed, options.speed);
  encoding.options().SetAttributeOptions(
      0, explicit_quantization({box.origin.x, box.origin.y, box.origin.z}, box.range, options.position_bits));
  encoding.set_unique_id(0, format.position_id);
  for (size_t a : chosen) {
    const int number = encoding.add(a, format.attributes[a]);
    set_quantization(encoding, number, mesh.attributes.attributes[a], format.attributes[a], attributes.grids[a]);
  }
  if (options.normals) {
    const int number = encoding.add_vertices(draco::GeometryAttribute::NORMAL, vertex_normals(mesh));
    encoding.options().SetAttributeInt(number, "quantization_bits", normal_bits);
    encoding.set_unique_id(number, id_for_normals(format));
  }
  return encoding.run();
}

std::string write_draco_exact(const TriangleMesh& triangles, const MeshFormat& format) {
  const Mesh mesh = build_mesh(triangles);
  Encoding encoding(mesh, !format.attributes.empty());
  encoding.set_unique_id(0, format.position_id);
  for (size_t a = 0; a < format.attributes.size(); ++a) encoding.add(a, format.attributes[a]);
  return encoding.run();
}

std::string_view draco_version() { return draco::kDracoVersion; }

}  // namespace papilio::proto
