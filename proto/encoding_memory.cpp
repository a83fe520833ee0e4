#include "proto/encoding_memory.h"

#include <algorithm>

#include "proto/draco_attributes.h"

namespace papilio::proto {
namespace {

// Measured on meshes of half a million faces and rounded up. tests/unit/compute_memory_test.cpp checks them in a
// process with limited memory.
constexpr uint64_t face_bytes = 75;            // corners, their order, positions on the grid and symbols
constexpr uint64_t seam_face_bytes = 36;       // surface cut open along an attribute's seams
constexpr uint64_t attribute_face_bytes = 3;   // marks of seams
constexpr uint64_t attribute_point_bytes = 4;  // value indices of the points
constexpr uint64_t value_point_bytes = 12;     // order of the values
constexpr uint64_t component_point_bytes = 8;  // integers and symbols of one attribute
constexpr uint64_t stream_copies = 2;          // growth or hand-over of the stream
constexpr uint64_t dressed_face_bytes = 60;    // copy of the mesh, and the normal's number at each corner
constexpr uint64_t dressed_point_bytes = 70;   // new normals and their sums
constexpr uint64_t coded_component_bytes = 2;  // a predicted component in the stream

/// Returns the bytes of a component as Draco stores it.
uint64_t size_of(ValueType type) {
  return with_number(type, [](auto number) { return uint64_t{sizeof number}; });
}

}  // namespace

OutputBytes encoding_bytes(const std::vector<Attribute>& coarse, bool adds_normals, const MeshFormat& format) {
  OutputBytes bytes{.face = face_bytes, .point = 0};
  uint64_t most_components = 0;
  const auto add = [&](ValueType type, uint64_t components) {
    const uint64_t in_stream = size_of(type) > sizeof(float) ? size_of(type) : coded_component_bytes;
    bytes.face += attribute_face_bytes;
    bytes.point += attribute_point_bytes + components * (size_of(type) + stream_copies * in_stream);
    most_components = std::max(most_components, components);
  };
  for (size_t a = 0; a < format.attributes.size(); ++a) add(format.attributes[a].type, coarse[a].components);
  if (adds_normals) add(ValueType::float32, 3);
  if (most_components > 0) bytes.face += seam_face_bytes;
  const auto is_normal = [](const AttributeFormat& attribute) { return attribute.kind == AttributeKind::normal; };
  if (adds_normals || std::ranges::any_of(format.attributes, is_normal)) {
    bytes.face += dressed_face_bytes;
    bytes.point += dressed_point_bytes;
    for (const Attribute& attribute : coarse) bytes.point += sizeof(double) * attribute.components;
  }
  if (most_components > 0) bytes.point += value_point_bytes + component_point_bytes * most_components;
  return bytes;
}

}  // namespace papilio::proto
