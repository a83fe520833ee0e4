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

// Mesh files of every kind as what a refinement takes and gives: Draco streams, and scenes as .glb files.

namespace papilio::client {

/// Limits of meshes on a user's own machine: what the core can number.
inline constexpr proto::Limits own_limits{face_count_limit, face_count_limit, face_count_limit};

/// Where a mesh comes from or goes to.
struct MeshPlace {
  std::filesystem::path path{};    ///< "-": standard input or output
  std::optional<Format> format{};  ///< nothing: by the extension; of standard input by its content, of output .drc

  [[nodiscard]] bool is_standard() const { return path == "-"; }
  /// What an input is called in messages.
  [[nodiscard]] std::string name() const { return is_standard() ? standard_input_name : path.string(); }
};

/// A mesh file as it was read. A .gltf file is packed: its bytes are those of a .glb file.
struct MeshBytes {
  std::string name;  ///< for messages
  Format format = Format::drc;
  std::string bytes{};
  std::vector<std::string> warnings{};  ///< images of a .gltf file that could not be packed
};

/// Reads a mesh file without a look at its content, but for the files that a .gltf file names: relative URIs in its
/// folder or below. Throws `FileError`, also where it is empty or a buffer is not there.
[[nodiscard]] MeshBytes read_mesh(const MeshPlace& place);

/// A mesh file's triangles and attributes, those of all nodes of a scene. Throws `FileError`.
[[nodiscard]] proto::FormattedMesh triangles_of(const MeshBytes& file);

/// A mesh file as a Draco stream: .drc as it is, others encoded with their positions and attributes to the bit. Throws
/// `FileError`, also where there is no surface in the file.
[[nodiscard]] std::string draco_of(MeshBytes file);
/// A mesh as a Draco stream with its positions and attributes to the bit, and the materials of its faces as an
/// attribute (material_attribute.h) if it has any. `name` is the file's. Throws `FileError`.
[[nodiscard]] std::string draco_of(const std::string& name, proto::gltf::MaterialMesh model);

/// The format of what is written there. Throws `FileError` for an extension that is unknown or not that of the format.
[[nodiscard]] Format output_format(const MeshPlace& place);

/// Whether files at the place can have materials: scenes, and OBJ files that are not standard output.
[[nodiscard]] bool holds_materials(const MeshPlace& place);

/// Whether files of a format can have normals of vertices.
[[nodiscard]] bool holds_normals(Format format);

/// Writes a mesh in the format of the place, which is not Draco; as a scene of one node where that is glTF, with its
/// materials where `holds_materials`. Throws `FileError`.
void save_mesh(const MeshPlace& place, const proto::gltf::MaterialMesh& model);

/// Writes a Draco stream as `save_mesh`. `materials`: those that the stream's faces name by `draco_of`; of a
/// stream whose faces name none the first one is that of all.
void save_draco(const MeshPlace& place, std::string_view draco, const proto::gltf::Materials& materials = {});

/// Writes a .glb scene in the format of the place; beside NAME.gltf goes NAME.bin. Throws `FileError`.
void save_scene(const MeshPlace& place, const std::string& glb);

/// Writes a file's bytes, to a file all or nothing. Throws `FileError`.
void save_bytes(const MeshPlace& place, std::string_view bytes);

}  // namespace papilio::client
