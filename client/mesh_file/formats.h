#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "client/mesh_file/obj_file.h"
#include "proto/mesh_format.h"

// Readers and writers of the four formats, included by mesh_file.cpp only.
//
// OpenMesh 9.0's readers are not used, as only a second parser could guard them. On damaged files they abort (OBJ
// `f /1/2`: an assert), crash (PLY, a property before any element), never end (PLY cut within its header), or run and
// grow with declared counts (PLY, OFF). On valid files they lose degenerate faces (OBJ, STL), weld by an epsilon and
// turn -0 into 0 (STL), and shift every index after a NaN vertex (OBJ). They return nothing from OFF with a comment or
// with its counts beside the keyword, and misread binary PLY with a second list on its faces. They keep global state,
// so that two threads may not read at once. The writers share that state, require an exporter of 43 methods, and write
// NaN normals (STL). Tests compare these readers with OpenMesh on valid files.
namespace papilio::client {

/// Error in bytes of a format, with its place. mesh_file.cpp adds the name of the file.
struct ParseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[nodiscard]] ObjFile parse_obj_file(std::string_view bytes);
[[nodiscard]] proto::FormattedMesh parse_obj(std::string_view bytes);
[[nodiscard]] TriangleMesh parse_off(std::string_view bytes);
[[nodiscard]] proto::FormattedMesh parse_ply(std::string_view bytes);
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes);

/// Returns whether the bytes are certainly an STL file: binary of the size of its count, or a text that starts with
/// `solid`.
[[nodiscard]] bool looks_like_stl(std::string_view bytes);

/// Formats a mesh as OBJ. Indices must be in range. `format` describes all attributes of the mesh, in order, or none.
[[nodiscard]] std::string format_obj(const TriangleMesh& mesh, const proto::MeshFormat& format,
                                     const ObjMaterials& materials = {});
[[nodiscard]] std::string format_off(const TriangleMesh& mesh);
[[nodiscard]] std::string format_ply(const TriangleMesh& mesh, const proto::MeshFormat& format);
[[nodiscard]] std::string format_stl(const TriangleMesh& mesh);

}  // namespace papilio::client
