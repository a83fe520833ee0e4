#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "client/mesh_file/file_bytes.h"
#include "proto/mesh_format.h"

namespace papilio::client {

/// The kinds of mesh files, by what their names end in.
enum class Format { drc, obj, ply, off, stl, glb, gltf };

/// Whether files of the format hold scenes, which `proto` reads and writes.
[[nodiscard]] bool is_scene(Format format);

/// "drc", "obj", "ply", "off", "stl", "glb", "gltf".
[[nodiscard]] std::string_view name_of(Format format);
/// The reverse of `name_of`; nothing for any other text.
[[nodiscard]] std::optional<Format> format_named(std::string_view name);

/// By the extension, in upper or lower case; nothing for an unknown one.
[[nodiscard]] std::optional<Format> known_format_of(const std::filesystem::path& path);
/// By the extension. Throws `FileError` that names the extension and those that are known.
[[nodiscard]] Format format_of(const std::filesystem::path& path);
/// By what the bytes begin with: Draco's, PLY's or glTF's magic, the brace of JSON, OFF's keyword or counts, `solid` or
/// the size of a binary STL file, or lines of an OBJ file. `name` is for messages. Throws `FileError` where none fits.
[[nodiscard]] Format format_of_content(const std::string& name, std::string_view bytes);

/// The largest file that is read: 4 GiB.
inline constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;

/// Positions and triangles as they stand in the file: repeated, degenerate and non-manifold faces are kept,
/// unused positions too. Polygons are cut into triangles (polygon.h); polygons of one or two corners,
/// which OFF and PLY allow, are left out. Text may begin with the byte order mark of UTF-8. A binary STL file may be
/// longer than its count asks for, but not by a whole number of triangles. OBJ's texture coordinates (`vt`, of two or
/// three numbers) and normals (`vn`) are attributes: each position is then one point for each pair of them that faces
/// name with it; where a corner lacks one it is zero. OBJ's smoothing groups (`s`) are an attribute named
/// smoothing_group if faces are in different ones; its materials are read by `parse_obj_file` alone (obj_file.h). PLY's
/// normals, colours and texture coordinates of vertices are attributes. Attributes of OFF and STL, and materials of
/// other formats than OBJ, are not read. STL has no shared vertices: three new positions for each triangle. Coordinates
/// that are NaN or infinite are passed on.
///
/// Throws `FileError` if the file cannot be read, is empty, damaged or cut short (as far as its format lets
/// one tell), names a vertex, texture coordinate or normal that does not exist, has a coordinate too large for a float,
/// or holds no triangle; and `std::logic_error` for `Format::drc` and scenes, whose bytes are read by `proto`. Memory
/// stays within a small multiple of the file's size, whatever counts the file declares. Any number of threads may call
/// it.
[[nodiscard]] proto::FormattedMesh read_triangles(const std::filesystem::path& path, Format format);
/// `read_triangles` of a file's bytes. `name` is the file's, for messages.
[[nodiscard]] proto::FormattedMesh parse_triangles(const std::string& name, Format format, std::string_view bytes);

/// Writes through `write_atomically`. OBJ and OFF as text, in the shortest digits that give back the same
/// float; PLY and STL binary, little-endian. Positions survive to the bit in all four; STL loses what is
/// shared between triangles, and gives degenerate ones a zero normal. OBJ keeps the first texture coordinates of at
/// most three numbers and the first normals that `mesh_format` describes, as floats, and smoothing groups; PLY such
/// normals, texture coordinates of two numbers and the first colours, with a vertex for each point; OFF and STL keep
/// positions alone.
///
/// Throws `FileError` if it cannot be written; `std::invalid_argument` if a triangle names a vertex that does
/// not exist; `std::logic_error` for `Format::drc` and scenes.
void write_triangles(const std::filesystem::path& path, Format format, const TriangleMesh& mesh,
                     const proto::MeshFormat& mesh_format = {});
/// The bytes that `write_triangles` writes. `name` is the file's, for messages.
[[nodiscard]] std::string encode_triangles(const std::string& name, Format format, const TriangleMesh& mesh,
                                           const proto::MeshFormat& mesh_format = {});

}  // namespace papilio::client
