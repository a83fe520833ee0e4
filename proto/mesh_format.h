#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "papilio/mesh.h"

// Formats of a mesh's attributes, which the core does not need and a writer does.

namespace papilio::proto {

/// Purpose of an attribute, in Draco's order.
enum class AttributeKind : uint8_t { normal, color, tex_coord, generic };

/// Stored type of a component, in Draco's order.
enum class ValueType : uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, boolean };

/// Format of one attribute.
struct AttributeFormat {
  AttributeKind kind = AttributeKind::generic;
  ValueType type = ValueType::float32;
  bool normalized = false;  ///< integers represent the range from 0 (or -1) to 1
  uint32_t id = 0;          ///< Draco's unique id, which identifies the attribute to applications
  std::string name{};       ///< the metadata entry "name"; empty if there is none

  friend bool operator==(const AttributeFormat&, const AttributeFormat&) = default;
};

/// Returns whether an attribute of so many components holds unit normals that Draco codes on an octahedron.
[[nodiscard]] bool is_unit_normal(const AttributeFormat& format, uint32_t components);

/// Name of the generic attribute of one integer that holds each face's smoothing group, at all its points.
inline constexpr const char* smoothing_group_name = "smoothing_group";

/// Returns whether an attribute of so many components holds smoothing groups.
[[nodiscard]] bool is_smoothing_group(const AttributeFormat& format, uint32_t components);

/// Returns the stored number that represents 1: the maximum of a normalized integer type, else 1.
[[nodiscard]] double unit_value(const AttributeFormat& format);

/// Formats of all attributes of a mesh.
struct MeshFormat {
  uint32_t position_id = 0;                   ///< Draco's unique id of POSITION
  std::vector<AttributeFormat> attributes{};  ///< one for each of TriangleMesh::attributes

  friend bool operator==(const MeshFormat&, const MeshFormat&) = default;
};

/// Appends the format of unit normals, with the lowest free id.
void append_normals(MeshFormat& format);

/// A mesh with the formats of its attributes.
struct FormattedMesh : TriangleMesh {
  MeshFormat format;
};

}  // namespace papilio::proto
