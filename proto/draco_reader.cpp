#include "proto/draco_reader.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>

#include <memory>
#include <new>
#include <optional>
#include <stdexcept>

#include "proto/draco_attributes.h"
#include "proto/draco_header.h"
#include "proto/draco_merges.h"
#include "proto/draco_orientations.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

/// One of libdraco's decoders with bounded work. Attributes are checked after their declarations, before their values:
/// a few bytes can declare 255 attributes of 255 components with constant values. Predictions are checked before use.
template <class Decoder>
class BoundedDecoder : public Decoder {
 public:
  std::unique_ptr<draco::Mesh> run(std::string_view bytes) {
    stream_.Init(bytes.data(), bytes.size());
    auto mesh = std::make_unique<draco::Mesh>();
    const bool ok = this->Decode(draco::DecoderOptions(), &stream_, mesh.get()).ok();
    if (refusal_) throw Problem(*refusal_);
    return ok ? std::move(mesh) : nullptr;
  }

 private:
  bool DecodeAllAttributes() override {
    try {
      require_attributes_within_limits(*this->point_cloud());
    } catch (const Problem& problem) {  // libdraco is built without exceptions
      refusal_ = problem;
      return false;
    }
    return Decoder::DecodeAllAttributes();
  }

  /// Checks the prediction. libdraco calls it once for each attribute predicted from the mesh, before its values.
  const draco::MeshAttributeIndicesEncodingData* GetAttributeEncodingData(int number) const override {
    const auto* data = Decoder::GetAttributeEncodingData(number);
    if (data == nullptr || has_valid_prediction(stream_, data->encoded_attribute_value_index_to_corner_map.size(),
                                                this->point_cloud()->attribute(number)->num_components()))
      return data;
    refusal_.emplace(Code::mesh_not_draco,
                     "Attribute " + std::to_string(this->point_cloud()->attribute(number)->unique_id()) +
                         " of the Draco stream has an invalid prediction. Encode the mesh again.");
    return nullptr;
  }

  draco::DecoderBuffer stream_;
  mutable std::optional<Problem> refusal_;
};

std::unique_ptr<draco::Mesh> decode(std::string_view bytes, bool edgebreaker) {
  try {
    std::unique_ptr<draco::Mesh> mesh = edgebreaker ? BoundedDecoder<draco::MeshEdgebreakerDecoder>().run(bytes)
                                                    : BoundedDecoder<draco::MeshSequentialDecoder>().run(bytes);
    if (mesh) return mesh;
  } catch (const std::bad_alloc&) {  // sizes in a damaged stream
  } catch (const std::length_error&) {
  }
  throw Problem(Code::mesh_not_draco,
                "The Draco stream is damaged or truncated. Provide the whole file, or encode the mesh again.");
}

const draco::PointAttribute& position_attribute(const draco::Mesh& mesh) {
  if (mesh.NumNamedAttributes(draco::GeometryAttribute::POSITION) != 1)
    throw Problem(Code::mesh_unsupported,
                  "The mesh has " + std::to_string(mesh.NumNamedAttributes(draco::GeometryAttribute::POSITION)) +
                      " POSITION attributes; exactly one is required. Encode it again.");
  const draco::PointAttribute& attribute = *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (attribute.num_components() != 3 || attribute.data_type() != draco::DT_FLOAT32)
    throw Problem(Code::mesh_unsupported, "POSITION must have three 32-bit floats. Encode the mesh again.");
  return attribute;
}

/// Decodes a stream with bounded work. The mesh has faces.
std::unique_ptr<draco::Mesh> decode_draco(std::string_view bytes, const Limits& limits) {
  const DracoHeader header = read_draco_header(bytes, limits);
  if (header.edgebreaker) require_bounded_merges(bytes, header);
  std::unique_ptr<draco::Mesh> mesh = decode(bytes, header.edgebreaker);
  require_within(mesh->num_faces(), limits.max_input_faces, "faces");
  // Upper bound with seams: a point for every corner.
  require_within(mesh->num_points(), limits.max_input_vertices + 3 * limits.max_input_faces, "points");
  if (mesh->num_faces() == 0) throw Problem(Code::mesh_unusable, "The mesh has no faces. Provide a triangle mesh.");
  return mesh;
}

/// Returns the positions of the points.
Buffer<Vec3f> read_positions(const draco::Mesh& mesh) {
  const draco::PointAttribute& attribute = position_attribute(mesh);
  auto positions = Buffer<Vec3f>::for_overwrite(mesh.num_points());
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex value = attribute.mapped_index(p);
    if (value.value() >= attribute.size())
      throw Problem(Code::mesh_unusable,
                    "Point " + std::to_string(p.value()) + " has no position. Encode the mesh again.");
    attribute.GetValue(value, &positions[p.value()]);
  }
  return positions;
}

/// Returns the faces, whose indices it checks.
Buffer<Triangle> read_triangles(const draco::Mesh& mesh) {
  auto triangles = Buffer<Triangle>::for_overwrite(mesh.num_faces());
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t p = mesh.face(f)[corner].value();
      if (p >= mesh.num_points())
        throw Problem(Code::mesh_unusable, "Face " + std::to_string(f.value()) + " has point " + std::to_string(p) +
                                               "; the mesh has " + std::to_string(mesh.num_points()) +
                                               " points. Encode the mesh again.");
      triangles[f.value()][corner] = p;
    }
  }
  return triangles;
}

}  // namespace

FormattedMesh read_draco(std::string_view bytes, const Limits& limits) {
  const std::unique_ptr<draco::Mesh> mesh = decode_draco(bytes, limits);
  FormattedMesh out;
  out.positions = read_positions(*mesh);
  out.triangles = read_triangles(*mesh);
  read_attributes(*mesh, out);
  return out;
}

}  // namespace papilio::proto
