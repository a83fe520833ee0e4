#include "tests/bench/draco_peer.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <array>
#include <stdexcept>

namespace papilio::bench {

PeerMesh decode_for_peer(const std::string& draco) {
  draco::DecoderBuffer buffer;
  buffer.Init(draco.data(), draco.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const draco::PointAttribute& positions = *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);

  PeerMesh out;
  out.reserve(positions.size(), 3 * positions.size(), mesh.num_faces());
  for (uint32_t i = 0; i < positions.size(); ++i) {
    std::array<float, 3> p{};
    positions.GetValue(draco::AttributeValueIndex(i), p.data());
    out.add_vertex({p[0], p[1], p[2]});
  }
  const auto vertex = [&](draco::PointIndex point) {
    return PeerMesh::VertexHandle(static_cast<int>(positions.mapped_index(point).value()));
  };
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    out.add_face(vertex(face[0]), vertex(face[1]), vertex(face[2]));
  }
  return out;
}

std::string encode_for_peer(const PeerMesh& mesh, const proto::QuantizationBox& box,
                            const proto::OutputOptions& options) {
  draco::Mesh out;
  out.set_num_points(static_cast<uint32_t>(mesh.n_vertices()));
  out.SetNumFaces(mesh.n_faces());
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
  const int added = out.AddAttribute(description, true, static_cast<uint32_t>(mesh.n_vertices()));
  draco::PointAttribute& positions = *out.attribute(added);
  for (const auto v : mesh.vertices())
    positions.SetAttributeValue(draco::AttributeValueIndex(static_cast<uint32_t>(v.idx())), mesh.point(v).data());
  for (const auto f : mesh.faces()) {
    draco::Mesh::Face face;
    size_t i = 0;
    for (const auto v : f.vertices()) face[i++] = draco::PointIndex(static_cast<uint32_t>(v.idx()));
    out.SetFace(draco::FaceIndex(static_cast<uint32_t>(f.idx())), face);
  }

  draco::Encoder encoder;
  encoder.SetSpeedOptions(options.speed, options.speed);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  const std::array<float, 3> origin = {box.origin.x, box.origin.y, box.origin.z};
  encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, options.position_bits, 3, origin.data(),
                                           box.range);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(out, &buffer);
  if (!status.ok()) throw std::runtime_error(status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

}  // namespace papilio::bench
