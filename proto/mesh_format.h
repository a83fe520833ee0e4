#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_mesh.h"

// What the core does not need to know of a mesh's attributes, but whoever writes them back does.

namespace papilio::proto {

/// What an attribute is for; in Draco's order.
enum class AttributeKind : uint8_t { normal, color, tex_coord, generic };

/// What one component is stored as; in Draco's order.
enum class ValueType : uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, boolean };

struct AttributeFormat {
  AttributeKind kind = AttributeKind::generic;
  ValueType type = ValueType::float32;
  bool normalized = false;  ///< integers stand for the range from 0 (or -1) to 1
  uint32_t id = 0;          ///< Draco's unique id, by which applications know the attribute
  std::string name{};       ///< the metadata entry "name"; empty if there is none

  friend bool operator==(const AttributeFormat&, const AttributeFormat&) = default;
};

/// Returns whether an attribute of so many components holds unit normals that Draco codes on an octahedron.
[[nodiscard]] bool is_unit_normal(const AttributeFormat& format, uint32_t components);

/// The stored number that stands for 1: the largest of a normalized integer, else 1.
[[nodiscard]] double one_of(const AttributeFormat& format);

struct MeshFormat {
  uint32_t position_id = 0;                   ///< Draco's unique id of POSITION
  std::vector<AttributeFormat> attributes{};  ///< one for each of TriangleMesh::attributes

  friend bool operator==(const MeshFormat&, const MeshFormat&) = default;
};

/// A mesh as it was read, and how to write it back.
struct FormattedMesh : TriangleMesh {
  MeshFormat format;
};

}  // namespace papilio::proto
