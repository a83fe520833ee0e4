#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "client/mesh_file/mesh_file.h"
#include "proto/mesh_format.h"

// Mesh files of every kind as Draco streams, which are all that a refinement takes and gives.

namespace papilio::client {

/// A mesh file's triangles and attributes. Throws `FileError`, and `proto::Problem` for a bad Draco stream.
[[nodiscard]] proto::FormattedMesh load_triangles(const std::filesystem::path& path);

/// A mesh file as a Draco stream: .drc as it is, others encoded with their positions and attributes to the bit. Throws
/// `FileError`, and `Error` where there is no surface in the file.
[[nodiscard]] std::string load_draco(const std::filesystem::path& path);

/// Writes a Draco stream as the kind of file that the name asks for. Throws `FileError`.
void save_draco(const std::filesystem::path& path, std::string_view draco);

}  // namespace papilio::client
