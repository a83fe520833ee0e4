#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/gltf/container.h"
#include "proto/gltf/document.h"
#include "proto/gltf/meshopt.h"

namespace papilio::proto::gltf {

/// New content of a view.
struct ViewContent {
  uint32_t view = 0;
  std::string bytes;        ///< uncompressed bytes; empty if only `left_out` is known
  uint64_t left_out = 0;    ///< number of uncompressed bytes of a compressed view, which no buffer stores
  uint32_t stride = 0;      ///< bytes from element to element
  bool strided = false;     ///< whether the view declares its stride, as views of vertices do
  bool compressed = false;  ///< whether EXT_meshopt_compression compresses the view
  MeshoptMode mode = MeshoptMode::attributes;
  std::string encoded{};  ///< compressed bytes; empty until the view is written

  [[nodiscard]] uint64_t length() const { return bytes.size() + left_out; }
};

/// Returns the bytes of a compressed view.
[[nodiscard]] std::string encode_meshopt(const ViewContent& content);

/// Bytes of each buffer of a rewritten document, in order; none for `fallback` buffers.
using BufferPieces = std::vector<std::vector<Piece>>;

/// Replaces the contents of views, and updates views and buffers in the document's JSON. Old contents that no other
/// view shares are removed from their buffers; all other bytes are kept. Compressed views get a buffer of fallback
/// sizes. Views in `aliased` have lost their content, and refer to the bytes of another view. The pieces borrow from
/// `document`, whose buffers must outlive them.
[[nodiscard]] BufferPieces replace_contents(Document& document, std::vector<ViewContent> contents,
                                            const std::vector<uint32_t>& aliased);

}  // namespace papilio::proto::gltf
