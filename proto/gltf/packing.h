#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace papilio::proto::gltf {

/// Function that returns the bytes of a file by a document's relative URI. May throw exceptions of the caller.
using FileResolver = std::function<std::string(const std::string& uri)>;

/// Function that returns the bytes of an image file by a document's URI; nothing if it does not exist.
using ImageFinder = std::function<std::optional<std::string>(const std::string& uri)>;

/// Packs a .gltf file and the files that it refers to in one .glb file. Buffers become the binary chunk; a buffer whose
/// extras or extensions would be lost is embedded in the document. Images become views of the chunk; an image that is
/// not found, or of unknown type, keeps its URI. A .glb file is returned unchanged. Throws `Problem` as
/// read_document(), and exceptions of `resolve` and `find_image`.
[[nodiscard]] std::string pack_scene(std::string_view gltf, const FileResolver& resolve, const ImageFinder& find_image);

/// .gltf file and its binary file.
struct UnpackedScene {
  std::string document;
  std::vector<std::pair<std::string, std::string>> buffers{};  ///< name and bytes
};

/// Converts a .glb file to a .gltf file. Its binary chunk becomes a file named `binary_name`.
[[nodiscard]] UnpackedScene unpack_scene(std::string_view glb, const std::string& binary_name);

}  // namespace papilio::proto::gltf
