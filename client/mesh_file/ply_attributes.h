#pragma once

#include <span>
#include <string>
#include <vector>

#include "client/mesh_file/ply_header.h"
#include "proto/mesh_format.h"

// Normals (nx, ny, nz), colours (red, green, blue and alpha) and texture coordinates (s and t, u and v, texture_u and
// texture_v) of a PLY file's vertices.

namespace papilio::client {

/// Collector of the attributes of a vertex element.
class PlyAttributes {
 public:
  explicit PlyAttributes(const PlyElement& element);

  /// Adds a vertex by the first number of each of its properties, in order.
  void add(std::span<const double> numbers);
  void move_to(proto::FormattedMesh& mesh);

 private:
  std::vector<std::vector<size_t>> properties_;  ///< [attribute][component] index of the property
  std::vector<Attribute> attributes_;
  std::vector<proto::AttributeFormat> formats_;
};

/// Writer of attributes: the first of each kind with a type and components that PLY has names for.
class PlyAttributeWriter {
 public:
  PlyAttributeWriter(const TriangleMesh& mesh, const proto::MeshFormat& format);

  [[nodiscard]] const std::string& properties() const { return properties_; }  ///< lines of the header
  void append_values(std::string& bytes, size_t point) const;

 private:
  struct Chosen {
    const Attribute* attribute;
    bool as_bytes;  ///< whether values are written as bytes; else as floats
    double one;     ///< stored number that represents 1, if values are floats
  };
  std::vector<Chosen> chosen_;
  std::string properties_;
};

}  // namespace papilio::client
