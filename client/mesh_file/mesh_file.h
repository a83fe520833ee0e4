#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "client/mesh_file/file_bytes.h"
#include "proto/mesh_format.h"

namespace papilio::client {

/// Format of a mesh file, by its extension.
enum class Format { drc, obj, ply, off, stl, glb, gltf };

/// Returns whether files of the format contain scenes, which `proto` reads and writes.
[[nodiscard]] bool is_scene(Format format);

/// Returns "drc", "obj", "ply", "off", "stl", "glb" or "gltf".
[[nodiscard]] std::string_view name_of(Format format);
/// Returns the format of a name; nothing for other text.
[[nodiscard]] std::optional<Format> format_named(std::string_view name);

/// Returns the format by the extension, in upper or lower case; nothing for an unknown one.
[[nodiscard]] std::optional<Format> known_format_of(const std::filesystem::path& path);
/// Returns the format by the extension. Throws `FileError`, with the extension and the known ones.
[[nodiscard]] Format format_of(const std::filesystem::path& path);
/// Returns the format by the first bytes: Draco's, PLY's or glTF's magic, the brace of JSON, OFF's keyword or counts,
/// `solid` or the size of a binary STL file, or lines of an OBJ file. `name` is for messages. Throws `FileError` if
/// none matches.
[[nodiscard]] Format format_of_content(const std::string& name, std::string_view bytes);

/// Upper bound of the size of a file: 4 GiB.
inline constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;

/// Reads positions, triangles and attributes of a file. Repeated, degenerate and non-manifold faces are kept, and so
/// are unused positions. Polygons are triangulated (polygon.h); those of one or two corners, which OFF, PLY and many
/// OBJ files have, are dropped. Text may start with the byte order mark of UTF-8. Coordinates may be NaN or infinite.
/// - OBJ: texture coordinates (`vt`, of 2 or 3 numbers) and normals (`vn`) are attributes. A position becomes one point
///   for each pair of them that faces use with it; missing ones are zero. Smoothing groups (`s`) are an attribute named
///   smoothing_group if faces have different ones. Only parse_obj_file() reads materials (obj_file.h).
/// - PLY: normals, colours and texture coordinates of vertices are attributes.
/// - OFF: attributes are not read.
/// - STL: each triangle has three new positions. A binary file may be longer than its count requires, but not by a
///   whole number of triangles. Attributes are not read.
///
/// Throws `FileError` if the file is unreadable, empty, damaged or recognizably cut; if it has an index out of range, a
/// coordinate too large for a float, or no triangle. Throws `std::logic_error` for `Format::drc` and scenes, which
/// `proto` reads. Memory is bounded by a small multiple of the file's size, for any declared counts. Thread-safe.
[[nodiscard]] proto::FormattedMesh read_triangles(const std::filesystem::path& path, Format format);
/// Reads the bytes of a file as read_triangles() does. `name`: the file's name for messages.
[[nodiscard]] proto::FormattedMesh parse_triangles(const std::string& name, Format format, std::string_view bytes);

/// Writes a file by write_atomically(). Positions are exact in all formats.
/// - OBJ: text with the shortest exact digits; the first texture coordinates of at most 3 numbers and the first normals
/// that
///   `mesh_format` describes, as floats, and smoothing groups.
/// - PLY: binary, little-endian; the first normals, texture coordinates of 2 numbers and colours, with a vertex per
/// point.
/// - OFF: text with the shortest exact digits; positions only.
/// - STL: binary, little-endian; positions only, without shared vertices. Degenerate triangles get a zero normal.
///
/// Throws `FileError` if it cannot be written, `std::invalid_argument` for an index out of range, and
/// `std::logic_error` for `Format::drc` and scenes.
void write_triangles(const std::filesystem::path& path, Format format, const TriangleMesh& mesh,
                     const proto::MeshFormat& mesh_format = {});
/// Returns the bytes that write_triangles() writes. `name`: the file's name for messages.
[[nodiscard]] std::string encode_triangles(const std::string& name, Format format, const TriangleMesh& mesh,
                                           const proto::MeshFormat& mesh_format = {});

}  // namespace papilio::client
