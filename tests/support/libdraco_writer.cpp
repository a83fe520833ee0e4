#include "tests/support/libdraco_writer.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "proto/draco_attributes.h"

namespace papilio::test {
namespace {

using namespace proto;

int add_vertex_attribute(draco::Mesh& out, draco::GeometryAttribute::Type type, const Buffer<Vec3f>& values,
                         const VertexPoints* points) {
  draco::GeometryAttribute description;
  description.Init(type, nullptr, 3, draco::DT_FLOAT32, false, sizeof(Vec3f), 0);
  const int number = out.AddAttribute(description, points == nullptr, static_cast<uint32_t>(values.size()));
  draco::PointAttribute& added = *out.attribute(number);
  added.buffer()->Write(0, values.data(), values.size() * sizeof(Vec3f));
  if (points != nullptr)
    for (uint32_t p = 0; p < points->vertex().size(); ++p)
      added.SetPointMapEntry(draco::PointIndex(p), draco::AttributeValueIndex(points->vertex()[p]));
  return number;
}

int add_point_attribute(draco::Mesh& out, const StoredValues& values, uint32_t components,
                        const AttributeFormat& format) {
  draco::GeometryAttribute description;
  const int64_t stride = int64_t{components} * draco::DataTypeLength(draco_type(format.type));
  description.Init(draco_type(format.kind), nullptr, static_cast<uint8_t>(components), draco_type(format.type),
                   format.normalized, stride, 0);
  const int number = out.AddAttribute(description, false, static_cast<uint32_t>(values.bytes.size() / stride));
  draco::PointAttribute& added = *out.attribute(number);
  added.buffer()->Write(0, values.bytes.data(), values.bytes.size());
  for (uint32_t p = 0; p < values.value.size(); ++p)
    added.SetPointMapEntry(draco::PointIndex(p), draco::AttributeValueIndex(values.value[p]));
  added.set_unique_id(format.id);
  if (!format.name.empty()) {
    auto metadata = std::make_unique<draco::AttributeMetadata>();
    metadata->AddEntryString(name_entry, format.name);
    out.AddAttributeMetadata(number, std::move(metadata));
  }
  return number;
}

std::string exact_text(float value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// Sets the options of ExpertEncoder::SetAttributeExplicitQuantization exactly: that function writes numbers with six
/// decimals, too few for the box of a small mesh.
draco::Options explicit_quantization(const std::vector<float>& origin, float range, int bits) {
  std::string text;
  for (float component : origin) text += (text.empty() ? "" : " ") + exact_text(component);
  draco::Options options;
  options.SetInt("quantization_bits", bits);
  options.SetString("quantization_origin", text);
  options.SetString("quantization_range", exact_text(range));
  return options;
}

/// Conversion of a mesh for libdraco's encoder.
class Encoding {
 public:
  /// Points are the corners' points with `attributes`, and vertices without.
  Encoding(const Mesh& mesh, bool attributes, uint32_t position_id) : encoder_(out_) {
    if (attributes) points_.emplace(mesh);
    const Buffer<uint32_t>& corner = attributes ? mesh.attributes.point : mesh.topology.origin;
    out_.set_num_points(attributes ? mesh.attributes.point_count : mesh.topology.vertex_count);
    out_.SetNumFaces(mesh.topology.face_count());
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f)
      out_.SetFace(draco::FaceIndex(f), {draco::PointIndex(corner[3 * f]), draco::PointIndex(corner[3 * f + 1]),
                                         draco::PointIndex(corner[3 * f + 2])});
    add_vertex_attribute(out_, draco::GeometryAttribute::POSITION, mesh.positions, points());
    out_.attribute(0)->set_unique_id(position_id);
  }

  /// Null without attributes.
  [[nodiscard]] const VertexPoints* points() const { return points_ ? &*points_ : nullptr; }

  void add(const OutputAttribute& attribute) {
    const int number = add_point_attribute(out_, attribute.values, attribute.components, attribute.format);
    if (attribute.coding == Coding::octahedral) options().SetAttributeInt(number, "quantization_bits", attribute.bits);
    if (attribute.coding == Coding::grid)
      options().SetAttributeOptions(number,
                                    explicit_quantization(attribute.grid.origin, attribute.grid.range, attribute.bits));
    if (attribute.is_too_large) {
      options().SetAttributeInt(number, "prediction_scheme", draco::PREDICTION_NONE);
      encoder_.SetUseBuiltInAttributeCompression(false);  // an option of all attributes
    } else if (attribute.format.kind == AttributeKind::normal && attribute.coding != Coding::octahedral) {
      // Below speed 4 libdraco predicts all normals as octahedral: other integers change, or it writes out of bounds.
      options().SetAttributeInt(number, "prediction_scheme", draco::PREDICTION_DIFFERENCE);
    }
  }

  [[nodiscard]] draco::EncoderOptions& options() { return encoder_.options(); }

  std::string run() {
    // Set explicitly: the default at speed 10 is sequential, with eleven times the bytes.
    encoder_.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    // Above speed 5 libdraco would split vertices at seams and write their positions twice.
    if (points_) options().SetGlobalBool("split_mesh_on_seams", false);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder_.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error("Draco's encoder refuses the mesh: " + status.error_msg_string());
    return {buffer.data(), buffer.size()};
  }

 private:
  draco::Mesh out_;
  draco::ExpertEncoder encoder_;
  std::optional<VertexPoints> points_;
};

}  // namespace

std::string write_with_libdraco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                uint32_t position_id, std::span<const OutputAttribute> attributes) {
  Encoding encoding(mesh, !attributes.empty(), position_id);
  encoding.options().SetSpeed(options.speed, options.speed);
  encoding.options().SetAttributeOptions(
      0, explicit_quantization({box.origin.x, box.origin.y, box.origin.z}, box.range, options.position_bits));
  for (const OutputAttribute& attribute : attributes) encoding.add(attribute);
  return encoding.run();
}

std::string write_exact_with_libdraco(const TriangleMesh& triangles, const MeshFormat& format) {
  const Mesh mesh = build_mesh(triangles);
  Encoding encoding(mesh, !format.attributes.empty(), format.position_id);
  for (size_t a = 0; a < format.attributes.size(); ++a)
    encoding.add(exact_attribute(mesh.attributes.attributes[a], format.attributes[a], *encoding.points()));
  return encoding.run();
}

}  // namespace papilio::test
