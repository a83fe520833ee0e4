#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/gltf/container.h"
#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Place of a buffer's bytes.
enum class BufferPlace {
  binary_chunk,  ///< chunk of the .glb file
  data_uri,
  external,  ///< file beside the document
  fallback,  ///< none: the buffer only defines uncompressed sizes of views that EXT_meshopt_compression compresses
};

/// Bytes of one buffer of a document.
class SceneBuffer {
 public:
  SceneBuffer(BufferPlace place, std::string_view borrowed) : place_(place), borrowed_(borrowed) {}
  SceneBuffer(BufferPlace place, std::string owned) : place_(place), owned_(std::move(owned)) {}
  [[nodiscard]] BufferPlace place() const { return place_; }
  /// Returns exactly as many bytes as the document declares (`read_cut_document`: at most); none for `fallback`.
  [[nodiscard]] std::string_view bytes() const { return owned_.empty() ? borrowed_ : std::string_view(owned_); }

 private:
  BufferPlace place_;
  std::string_view borrowed_;
  std::string owned_;
};

/// Function that returns the bytes of a file by a document's relative URI. May throw exceptions of the caller.
using Resolver = std::function<std::string(const std::string& uri)>;

/// glTF document with its buffers.
struct Document {  // NOLINT(bugprone-exception-escape): moving JSON cannot throw
  Json json;
  std::vector<SceneBuffer> buffers;
  std::vector<ExtraChunk> extra;  ///< further chunks of a .glb file
  bool is_glb = false;
  /// Whether a buffer stores the uncompressed bytes of a view that EXT_meshopt_compression compresses. This is unusual.
  bool has_uncompressed_views = false;
};

/// Returns whether the bytes are a .glb file, or JSON that may be a glTF document.
[[nodiscard]] bool looks_like_gltf(std::string_view bytes);

/// Reads a .glb file or the JSON of a .gltf file, whose bytes must outlive the document. Without `resolve`, external
/// buffers are refused. Throws `Problem`: mesh_not_gltf, mesh_unsupported (another version, a required extension whose
/// geometry cannot be read, external buffers).
[[nodiscard]] Document read_document(std::string_view bytes, const Resolver& resolve = {});

/// Reads a .glb file that may end inside its binary chunk; the first buffer then has fewer bytes than declared. Throws
/// `Problem` as read_document().
[[nodiscard]] Document read_cut_document(std::string_view glb);

}  // namespace papilio::proto::gltf
