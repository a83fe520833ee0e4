#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace papilio::proto::gltf {

/// Returns the bytes of the file that a document names by a relative URI. May throw what its caller understands.
using FileResolver = std::function<std::string(const std::string& uri)>;

/// Returns the bytes of an image file that a document names, if it is there.
using ImageFinder = std::function<std::optional<std::string>(const std::string& uri)>;

/// Makes one .glb file of a .gltf file and those that it names. Its buffers become the binary chunk, but for those
/// whose extras or extensions would be lost, which become part of the document; and its images views of it; images that
/// are not found, or whose name does not tell their type, keep their URIs. A .glb file comes out as it is. Throws
/// `Problem` as `read_document`, and what `resolve` and `find_image` throw.
[[nodiscard]] std::string pack_scene(std::string_view gltf, const FileResolver& resolve, const ImageFinder& find_image);

/// A .gltf file and its binary one.
struct UnpackedScene {
  std::string document;
  std::vector<std::pair<std::string, std::string>> buffers{};  ///< name and bytes
};

/// Makes a .gltf file of a .glb file, whose binary chunk becomes a file named `binary_name`.
[[nodiscard]] UnpackedScene unpack_scene(std::string_view glb, const std::string& binary_name);

}  // namespace papilio::proto::gltf
