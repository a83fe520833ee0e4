#pragma once

#include <draco/mesh/mesh.h>

#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Conversion of attributes between Draco's meshes and the core. For the reader and the writer only.

namespace papilio::proto {

/// Metadata entry with the name of an attribute.
inline constexpr const char* name_entry = "name";

/// Throws `Problem` mesh_too_large for more than 16 attributes or 32 components besides the position. Reads no values.
void require_attributes_within_limits(const draco::PointCloud& mesh);

/// Reads all attributes but POSITION into `out`, whose positions must be set. Throws `Problem` mesh_unusable for a
/// point without a value.
void read_attributes(const draco::Mesh& mesh, FormattedMesh& out);

/// Mapping from the points of a mesh to its vertices.
class VertexPoints {
 public:
  explicit VertexPoints(const Mesh& mesh);

  [[nodiscard]] const std::vector<uint32_t>& vertex() const { return vertex_; }
  /// Returns the points of vertices with several points.
  [[nodiscard]] const std::vector<uint32_t>& on_seams() const { return on_seams_; }

 private:
  std::vector<uint32_t> vertex_;  ///< [points]
  std::vector<uint32_t> on_seams_;
};

/// Values of an attribute as Draco stores them. Integers are rounded and clamped to their range. Points of one vertex
/// share a value if theirs are equal, so seams of other attributes do not become seams of this one.
struct StoredValues {
  std::vector<char> bytes;      ///< [values][components] in the attribute's type
  std::vector<uint32_t> value;  ///< [points] index of each point's value
};
[[nodiscard]] StoredValues store_values(const Attribute& attribute, const AttributeFormat& format,
                                        const VertexPoints& points);

/// Calls `visit` with a zero of the C++ type that `type` stands for.
template <class Visit>
auto with_number(ValueType type, Visit visit) {
  switch (type) {
    case ValueType::int8:
      return visit(int8_t{});
    case ValueType::uint8:
      return visit(uint8_t{});
    case ValueType::int16:
      return visit(int16_t{});
    case ValueType::uint16:
      return visit(uint16_t{});
    case ValueType::int32:
      return visit(int32_t{});
    case ValueType::uint32:
      return visit(uint32_t{});
    case ValueType::int64:
      return visit(int64_t{});
    case ValueType::uint64:
      return visit(uint64_t{});
    case ValueType::float32:
      return visit(float{});
    case ValueType::float64:
      return visit(double{});
    case ValueType::boolean:
      break;
  }
  return visit(bool{});
}

[[nodiscard]] draco::GeometryAttribute::Type draco_type(AttributeKind kind);
[[nodiscard]] draco::DataType draco_type(ValueType type);

}  // namespace papilio::proto
