#include "proto/draco_writer.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <stdexcept>

#include "core/normals.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

constexpr int normal_bits = 10;
constexpr double smallest_range = 1e-30;  // below, Draco's steps a unit overflow

void add_attribute(draco::Mesh& out, draco::GeometryAttribute::Type type, const std::vector<Vec3f>& values) {
  draco::GeometryAttribute description;
  description.Init(type, nullptr, 3, draco::DT_FLOAT32, false, sizeof(Vec3f), 0);
  const int id = out.AddAttribute(description, true, static_cast<uint32_t>(values.size()));
  out.attribute(id)->buffer()->Write(0, values.data(), values.size() * sizeof(Vec3f));
}

std::unique_ptr<draco::Mesh> to_draco(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  auto result = std::make_unique<draco::Mesh>();  // draco::Mesh cannot be moved
  draco::Mesh& out = *result;
  out.set_num_points(topology.vertex_count);
  out.SetNumFaces(topology.face_count());
  for (uint32_t f = 0; f < topology.face_count(); ++f) {
    draco::Mesh::Face face;
    for (uint32_t i = 0; i < 3; ++i) face[i] = topology.origin[3 * f + i];
    out.SetFace(draco::FaceIndex(f), face);
  }
  add_attribute(out, draco::GeometryAttribute::POSITION, mesh.positions);
  return result;
}

std::string exact_text(float value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// What Encoder::SetAttributeExplicitQuantization sets, but to the bit: that writes numbers with six decimals, in which
/// the box of a small mesh is lost.
draco::Options explicit_quantization(const QuantizationBox& box, int bits) {
  draco::Options options;
  options.SetInt("quantization_bits", bits);
  options.SetString("quantization_origin",
                    exact_text(box.origin.x) + ' ' + exact_text(box.origin.y) + ' ' + exact_text(box.origin.z));
  options.SetString("quantization_range", exact_text(box.range));
  return options;
}

std::string encode(draco::Encoder& encoder, const draco::Mesh& mesh) {
  // Named, since the automatic choice is sequential at speed 10: eleven times the bytes.
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) throw std::runtime_error("Draco's encoder refuses the mesh: " + status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

}  // namespace

QuantizationBox quantization_box(const std::vector<Vec3f>& coarse) {
  const Box box = bounding_box(coarse);
  const Vec3d low = to_double(box.min);
  const Vec3d size = to_double(box.max) - low;
  const double range = 1.25 * std::max({size.x, size.y, size.z});
  if (range < smallest_range)
    throw Problem(Code::mesh_unusable, "The mesh is smaller than 1e-30 across, too small to be encoded. Scale it up.");
  const Vec3d centre = low + 0.5 * size;
  return {to_float(centre - 0.5 * Vec3d{range, range, range}), static_cast<float>(range)};
}

std::string write_draco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options) {
  const std::unique_ptr<draco::Mesh> out = to_draco(mesh);
  draco::Encoder encoder;
  encoder.SetSpeedOptions(options.speed, options.speed);
  encoder.options().SetAttributeOptions(draco::GeometryAttribute::POSITION,
                                        explicit_quantization(box, options.position_bits));
  if (options.normals) {
    add_attribute(*out, draco::GeometryAttribute::NORMAL, vertex_normals(mesh));
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, normal_bits);
  }
  return encode(encoder, *out);
}

std::string write_draco_exact(const TriangleMesh& mesh) {
  draco::Encoder encoder;
  return encode(encoder, *to_draco(build_mesh(mesh)));
}

}  // namespace papilio::proto
