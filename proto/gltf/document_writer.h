#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proto/gltf/buffer_writer.h"
#include "proto/gltf/document.h"

namespace papilio::proto::gltf {

/// Files of a scene: the document first, then the buffers that it names, by their URIs.
struct SceneFiles {
  std::string document;
  std::vector<std::pair<std::string, std::string>> buffers{};  ///< URI and bytes
};

/// Kind of file to write.
enum class FileKind { glb, gltf };

/// Returns the bytes of the buffers as they are, borrowed from the document.
[[nodiscard]] BufferPieces unchanged_pieces(const Document& document);

/// Writes a document with these bytes of its buffers. A .glb file holds all of them: what was a file of its own becomes
/// the binary chunk or, of several, a data URI. In a .gltf file the binary chunk becomes a file named `binary_name`;
/// buffers keep their URIs. Throws `Problem` result_too_large.
[[nodiscard]] SceneFiles write_document(Document& document, BufferPieces pieces, FileKind kind,
                                        const std::string& binary_name = "scene.bin");

}  // namespace papilio::proto::gltf
