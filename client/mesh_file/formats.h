#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "client/mesh_file/obj_file.h"
#include "proto/mesh_format.h"

/// The four formats between bytes and triangles; `mesh_file.h` is what others include.
///
/// They are written here because OpenMesh 9.0's readers, measured with an importer of our own, cannot be
/// guarded by less than a second parser. On damaged files they abort (OBJ `f /1/2`: an assert), crash (PLY, a
/// property before any element), never end (PLY cut within its header) or run and grow with whatever counts
/// are declared (PLY, OFF). On sound ones they lose degenerate faces (OBJ, STL), weld by an epsilon and turn
/// -0 into 0 (STL), shift every index after a vertex that is NaN (OBJ), return nothing from OFF with a
/// comment or with its counts beside the keyword, and misread binary PLY with a second list on its faces.
/// They keep state in global objects, so that two threads may not read at once. Its writers share that state,
/// ask for an exporter of 43 methods, and write NaN normals (STL). The tests hold these against OpenMesh on
/// sound files.
namespace papilio::client {

/// Bytes that are not what their format says: where and what. `mesh_file.cpp` adds the name of the file.
struct ParseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[nodiscard]] ObjFile parse_obj_file(std::string_view bytes);
[[nodiscard]] proto::FormattedMesh parse_obj(std::string_view bytes);
[[nodiscard]] TriangleMesh parse_off(std::string_view bytes);
[[nodiscard]] proto::FormattedMesh parse_ply(std::string_view bytes);
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes);

/// Whether it is surely an STL file: binary and of the size that its count asks for, or a text that begins with
/// `solid`.
[[nodiscard]] bool looks_like_stl(std::string_view bytes);

/// Indices must be in range. `format` describes all of the mesh's attributes, in order, or none.
[[nodiscard]] std::string format_obj(const TriangleMesh& mesh, const proto::MeshFormat& format,
                                     const ObjMaterials& materials = {});
[[nodiscard]] std::string format_off(const TriangleMesh& mesh);
[[nodiscard]] std::string format_ply(const TriangleMesh& mesh, const proto::MeshFormat& format);
[[nodiscard]] std::string format_stl(const TriangleMesh& mesh);

}  // namespace papilio::client
