#pragma once

#include <span>
#include <string>
#include <vector>

#include "client/mesh_file/ply_header.h"
#include "proto/mesh_format.h"

// Normals (nx, ny, nz), colours (red, green, blue and alpha) and texture coordinates (s and t, u and v, texture_u and
// texture_v) of a PLY file's vertices.

namespace papilio::client {

/// Collects what a vertex element has of them.
class PlyAttributes {
 public:
  explicit PlyAttributes(const PlyElement& element);

  /// The first number of each of a vertex's properties, in order.
  void add(std::span<const double> numbers);
  void move_to(proto::FormattedMesh& mesh);

 private:
  std::vector<std::vector<size_t>> properties_;  ///< of each attribute, component by component
  std::vector<Attribute> attributes_;
  std::vector<proto::AttributeFormat> formats_;
};

/// The other way: the first attribute of each kind whose type and components PLY has names for.
class PlyAttributeWriter {
 public:
  PlyAttributeWriter(const TriangleMesh& mesh, const proto::MeshFormat& format);

  [[nodiscard]] const std::string& properties() const { return properties_; }  ///< lines of the header
  void append_values(std::string& bytes, size_t point) const;

 private:
  struct Chosen {
    const Attribute* attribute;
    bool as_bytes;  ///< else as floats
    double one;     ///< what stands for 1 where numbers are floats
  };
  std::vector<Chosen> chosen_;
  std::string properties_;
};

}  // namespace papilio::client
