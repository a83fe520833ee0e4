#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

namespace papilio::proto {

/// The cube in whose grid positions are quantised. It comes from the coarse mesh alone, so that a vertex
/// stays where it is from level to level and from view to view.
struct QuantizationBox {
  Vec3f origin;     ///< lowest corner
  float range = 0;  ///< edge length
};

/// The bounding box's longest side, padded by an eighth on both sides since the surface swells, round the
/// box's centre. (What swells further still is encoded right: Draco's grid goes on beyond the cube.)
/// Throws `Problem` mesh_unusable for a mesh smaller than 1e-30.
[[nodiscard]] QuantizationBox quantization_box(const Buffer<Vec3f>& coarse);

/// How the attributes of a mesh are written. As with positions the grids come from the coarse mesh alone: values
/// between its own are all that interpolation makes.
struct AttributeEncoding {
  struct Grid {
    std::vector<float> origin;  ///< [components] lowest values
    float range = 0;            ///< widest extent of a component; 0: not quantised
  };
  MeshFormat format{};
  std::vector<Grid> grids{};  ///< one for each attribute
};
[[nodiscard]] AttributeEncoding attribute_encoding(const Mesh& coarse, MeshFormat format);

struct OutputOptions {
  int position_bits = 14;  ///< 8..16, bits of a coordinate
  int speed = 7;           ///< 0..10, Draco's encoding speed: 0 smallest, 10 fastest
  bool normals = false;    ///< adds unit normals of the vertices, at 10 bits, in place of the mesh's own
};

/// Encodes the mesh as a Draco 2.2 edgebreaker stream (edgebreaker/writer.h). The mesh must have faces; positions must
/// be finite. Each vertex has one position, but where several fans of faces meet at a vertex it is written once for
/// each. Attributes that `attributes` describes (all, in order, or none) have their seams. 32-bit floats are quantised:
/// texture coordinates at 14 bits, unit normals at 10, the rest at 16. All else is kept: integers (uint32 to 2^31 - 1),
/// float64, normals that are not three floats, floats with a range that is no float's. `poll`, if any, is called every
/// few milliseconds; it may throw to stop.
[[nodiscard]] std::string write_draco(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                      const AttributeEncoding& attributes = {}, const std::function<void()>& poll = {});

/// Encodes triangles as they are, positions and the attributes of `format` to the bit: what the client sends of a mesh
/// that is not Draco yet. Isolated points and degenerate faces are dropped, points of equal position welded. Throws
/// `Error` as `build_mesh`.
[[nodiscard]] std::string write_draco_exact(const TriangleMesh& triangles, const MeshFormat& format = {});

/// Of the library that writes: other versions may write other bytes.
[[nodiscard]] std::string_view draco_version();

}  // namespace papilio::proto
