#pragma once

#include <draco/mesh/mesh.h>

#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Attributes between Draco's meshes and the core. For the reader and the writer only.

namespace papilio::proto {

/// The metadata entry that names an attribute.
inline constexpr const char* name_entry = "name";

/// Throws `Problem` mesh_too_large for more than 16 attributes or 32 components besides a position. Needs no values.
void require_attributes_within_limits(const draco::PointCloud& mesh);

/// Reads everything but POSITION into `out`, whose positions are there already. Throws `Problem` mesh_unusable (a point
/// without a value).
void read_attributes(const draco::Mesh& mesh, FormattedMesh& out);

/// Which points of a mesh lie at which vertex.
class VertexPoints {
 public:
  explicit VertexPoints(const Mesh& mesh);

  [[nodiscard]] const std::vector<uint32_t>& vertex() const { return vertex_; }
  /// Points of vertices that have several of them.
  [[nodiscard]] const std::vector<uint32_t>& on_seams() const { return on_seams_; }

 private:
  std::vector<uint32_t> vertex_;  ///< [P]
  std::vector<uint32_t> on_seams_;
};

/// The values of an attribute as Draco stores them. Integers are rounded and held to their range. Points of one vertex
/// share a value where theirs are the same, so that it has only its own seams.
struct StoredValues {
  std::vector<char> bytes;      ///< [values] in the attribute's type, component by component
  std::vector<uint32_t> value;  ///< [P] the number of each point's value
};
[[nodiscard]] StoredValues store_values(const Attribute& attribute, const AttributeFormat& format,
                                        const VertexPoints& points);

/// Calls `visit` with a number (0) of the type.
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
