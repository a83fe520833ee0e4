#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"
#include "proto/quantization_box.h"

namespace papilio::proto {

/// Formats and grids of written attributes. The grids depend on the coarse mesh alone, as interpolated values stay in
/// its range.
struct AttributeEncoding {
  struct Grid {
    std::vector<float> origin;  ///< [components] lowest values
    float range = 0;            ///< widest extent of a component; 0: not quantized
  };
  MeshFormat format{};
  std::vector<Grid> grids{};  ///< one for each attribute
};
/// Returns the grid of an attribute's values.
[[nodiscard]] AttributeEncoding::Grid grid_of(const Attribute& attribute);
/// Returns the encoding of the attributes of refinements of `coarse`.
[[nodiscard]] AttributeEncoding attribute_encoding(const Mesh& coarse, MeshFormat format);

struct OutputOptions {
  int position_bits = 14;  ///< bits of a coordinate, 8 to 16
  int speed = 7;           ///< Draco's encoding speed: 0 smallest, 10 fastest
};

/// Encodes the mesh as a Draco 2.2 edgebreaker stream (edgebreaker/writer.h). The mesh must have faces and finite
/// positions. A vertex has one position for each of its fans of faces. `attributes` describes all attributes in order,
/// or none. 32-bit floats are quantized: texture coordinates to 14 bits, unit normals to 10, others to 16. Kept exactly
/// are integers (uint32 up to 2^31 - 1), float64, normals that are not three floats, and floats whose range overflows.
/// Calls `poll`, unless empty, every few milliseconds; it may throw to stop.
[[nodiscard]] std::string write_draco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                      const AttributeEncoding& attributes = {}, const std::function<void()>& poll = {});

/// Encodes triangles with exact positions and exact attributes of `format`. The client sends meshes of other formats
/// this way. Isolated points and degenerate faces are removed; points of equal position are welded. Throws `Error` like
/// `build_mesh`.
[[nodiscard]] std::string write_draco_exact(const TriangleMesh& triangles, const MeshFormat& format = {});

/// Returns the version of libdraco, on which encoded bytes depend.
[[nodiscard]] std::string_view draco_version();

}  // namespace papilio::proto
