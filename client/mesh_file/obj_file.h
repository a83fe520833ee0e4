#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proto/mesh_format.h"

namespace papilio::client {

/// Most materials of an OBJ file or of a material library, and most different `mtllib` lines.
inline constexpr size_t most_materials = 65536;
inline constexpr size_t most_libraries = 1024;

/// Names of materials in an OBJ file, as bytes of any encoding.
struct ObjMaterials {
  std::vector<std::string> libraries{};  ///< what follows each different `mtllib`: one or several file names
  std::vector<std::string> names{};      ///< of the materials that faces have; "" is a name too
  std::vector<uint32_t> of_triangle{};   ///< in `names`, `none` for none; empty without names
};

/// An OBJ file: its mesh, and what it says of materials.
struct ObjFile {
  proto::FormattedMesh mesh;
  ObjMaterials materials{};
};

/// `parse_triangles` of an OBJ file, with its materials. Throws `FileError`.
[[nodiscard]] ObjFile parse_obj_file(const std::string& name, std::string_view bytes);

/// `encode_triangles` as OBJ with `mtllib` and `usemtl` lines, so that faces of one material follow each other: those
/// without a material first, then by its number.
[[nodiscard]] std::string encode_obj(const std::string& name, const TriangleMesh& mesh,
                                     const proto::MeshFormat& mesh_format, const ObjMaterials& materials);

}  // namespace papilio::client
