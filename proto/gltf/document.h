#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/gltf/container.h"
#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Where the bytes of a buffer are.
enum class BufferPlace {
  binary_chunk,  ///< the chunk of the .glb file
  data_uri,
  external,  ///< a file beside the document
  fallback,  ///< nowhere: it only gives uncompressed sizes to views that EXT_meshopt_compression compresses
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

/// Returns the bytes of the file that a document names by a relative URI. May throw what its caller understands.
using Resolver = std::function<std::string(const std::string& uri)>;

/// A glTF document with its buffers.
struct Document {  // NOLINT(bugprone-exception-escape): moving JSON cannot throw
  Json json;
  std::vector<SceneBuffer> buffers;
  std::vector<ExtraChunk> extra;  ///< of a .glb file
  bool is_glb = false;
  /// Whether a buffer has the uncompressed bytes of a view that EXT_meshopt_compression compresses. None has as a rule.
  bool has_uncompressed_views = false;
};

/// Returns whether the bytes are a .glb file, or JSON that may be a glTF document.
[[nodiscard]] bool looks_like_gltf(std::string_view bytes);

/// Reads a .glb file or the JSON of a .gltf file, whose bytes must outlive the document. Without `resolve` no file is
/// fetched: external buffers are refused. Throws `Problem`: mesh_not_gltf, mesh_unsupported (another version, a
/// required extension whose geometry cannot be read, external buffers).
[[nodiscard]] Document read_document(std::string_view bytes, const Resolver& resolve = {});

/// Reads a .glb file that may end inside its binary chunk: the first buffer then has fewer bytes than the document
/// declares. Throws `Problem` as `read_document`.
[[nodiscard]] Document read_cut_document(std::string_view glb);

}  // namespace papilio::proto::gltf
