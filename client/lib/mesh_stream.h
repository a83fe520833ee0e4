#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/mesh_file/mesh_file.h"
#include "papilio/mesh.h"
#include "proto/gltf/materials.h"
#include "proto/limits.h"
#include "proto/mesh_format.h"

// Conversion between mesh files and the input and output of a refinement: Draco streams, and scenes as .glb files.

namespace papilio::client {

/// Limits of local refinement: the core's limit on faces.
inline constexpr proto::Limits own_limits{face_count_limit, face_count_limit, face_count_limit};

/// Source or target of a mesh.
struct MeshPlace {
  std::filesystem::path path{};    ///< path; "-": standard input or output
  std::optional<Format> format{};  ///< format; nothing: by extension, standard input by content, standard output .drc

  [[nodiscard]] bool is_standard() const { return path == "-"; }
  /// Returns the name of an input for messages.
  [[nodiscard]] std::string name() const { return is_standard() ? standard_input_name : path.string(); }
};

/// Bytes of a mesh file. A .gltf file is packed to a .glb file.
struct MeshBytes {
  std::string name;  ///< name for messages
  Format format = Format::drc;
  std::string bytes{};
  std::vector<std::string> warnings{};  ///< warnings of images of a .gltf file that could not be packed
};

/// Reads a mesh file, without parsing its content. Also reads the files that a .gltf file refers to, by relative URIs
/// in its folder or below. Throws `FileError`, also if the file is empty or a buffer is missing.
[[nodiscard]] MeshBytes read_mesh(const MeshPlace& place);

/// Returns the triangles and attributes of a mesh file, of all nodes of a scene. Throws `FileError`.
[[nodiscard]] proto::FormattedMesh triangles_of(const MeshBytes& file);

/// Returns a mesh file as a Draco stream: .drc unchanged, others encoded with exact positions and attributes. Throws
/// `FileError`, also if the file has no surface.
[[nodiscard]] std::string draco_of(MeshBytes file);
/// Returns a mesh as a Draco stream with exact positions and attributes, and with the materials of its faces, if any,
/// as an attribute (material_attribute.h). `name`: the file's name. Throws `FileError`.
[[nodiscard]] std::string draco_of(const std::string& name, proto::gltf::MaterialMesh model);

/// Returns the format of an output. Throws `FileError` for an extension that is unknown or of another format.
[[nodiscard]] Format output_format(const MeshPlace& place);

/// Returns whether files at the place can store materials: scenes, and OBJ files other than standard output.
[[nodiscard]] bool holds_materials(const MeshPlace& place);

/// Returns whether files of a format can store normals of vertices.
[[nodiscard]] bool holds_normals(Format format);

/// Writes a mesh in the format of the place, which is not Draco: glTF as a scene of one node, with materials if
/// holds_materials(). Throws `FileError`.
void save_mesh(const MeshPlace& place, const proto::gltf::MaterialMesh& model);

/// Writes a Draco stream as save_mesh() does. `materials`: materials of the stream's faces, as of draco_of(); without
/// an attribute of materials, the first one applies to all faces.
void save_draco(const MeshPlace& place, std::string_view draco, const proto::gltf::Materials& materials = {});

/// Writes a .glb scene in the format of the place; a .gltf file is accompanied by NAME.bin. Throws `FileError`.
void save_scene(const MeshPlace& place, const std::string& glb);

/// Writes bytes, to a file atomically. Throws `FileError`.
void save_bytes(const MeshPlace& place, std::string_view bytes);

}  // namespace papilio::client
