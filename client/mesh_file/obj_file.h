#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proto/mesh_format.h"

namespace papilio::client {

/// Upper bound of the materials of an OBJ file or a material library, and of different `mtllib` lines.
inline constexpr size_t most_materials = 65536;
inline constexpr size_t most_libraries = 1024;

/// Names of materials in an OBJ file, as bytes of any encoding.
struct ObjMaterials {
  std::vector<std::string> libraries{};  ///< text after each different `mtllib`: one or several file names
  std::vector<std::string> names{};      ///< names of materials that faces use; "" is a valid name
  std::vector<uint32_t> of_triangle{};   ///< [triangles] index in `names`, or `none`; empty without names
};

/// OBJ file: its mesh, and its materials.
struct ObjFile {
  proto::FormattedMesh mesh;
  ObjMaterials materials{};
};

/// Parses an OBJ file with its materials, as parse_triangles(). Throws `FileError`.
[[nodiscard]] ObjFile parse_obj_file(const std::string& name, std::string_view bytes);

/// Encodes a mesh as OBJ with `mtllib` and `usemtl` lines, as encode_triangles(). Faces are sorted by material, with
/// faces without a material first.
[[nodiscard]] std::string encode_obj(const std::string& name, const TriangleMesh& mesh,
                                     const proto::MeshFormat& mesh_format, const ObjMaterials& materials);

}  // namespace papilio::client
