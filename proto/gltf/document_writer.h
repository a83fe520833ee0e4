#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proto/gltf/buffer_writer.h"
#include "proto/gltf/document.h"

namespace papilio::proto::gltf {

/// Files of a scene: the document, and the buffers that it refers to.
struct SceneFiles {
  std::string document;
  std::vector<std::pair<std::string, std::string>> buffers{};  ///< URI and bytes
};

/// Kind of file to write.
enum class FileKind { glb, gltf };

/// Returns the unchanged bytes of the buffers, borrowed from the document.
[[nodiscard]] BufferPieces unchanged_pieces(const Document& document);

/// Writes a document with new bytes of its buffers. A .glb file contains all buffers: an external one becomes the
/// binary chunk, or if there are several, a data URI. In a .gltf file the binary chunk becomes a file named
/// `binary_name`; other buffers keep their URIs. Throws `Problem` result_too_large.
[[nodiscard]] SceneFiles write_document(Document& document, BufferPieces pieces, FileKind kind,
                                        const std::string& binary_name = "scene.bin");

}  // namespace papilio::proto::gltf
