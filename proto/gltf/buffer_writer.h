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
  std::string bytes;        ///< uncompressed; empty where only their number is given
  uint64_t left_out = 0;    ///< their number, where no buffer needs them as the view is compressed
  uint32_t stride = 0;      ///< bytes from element to element
  bool strided = false;     ///< whether the view declares its stride, as those of vertices do
  bool compressed = false;  ///< by EXT_meshopt_compression
  MeshoptMode mode = MeshoptMode::attributes;
  std::string encoded{};  ///< compressed; empty: to be compressed when it is written

  [[nodiscard]] uint64_t length() const { return bytes.size() + left_out; }
};

/// Returns the bytes of a compressed view.
[[nodiscard]] std::string encode_meshopt(const ViewContent& content);

/// Bytes of each buffer of a rewritten document, in order. Those of `fallback` buffers have none.
using BufferPieces = std::vector<std::vector<Piece>>;

/// Puts new contents in place of those of their views. Old contents that no other view holds are removed from their
/// buffers; all else stays, to the byte. Updates the views and buffers of the document's JSON. A view that compression
/// needs is given a buffer of fallback sizes. Views in `aliased` have lost their content, and take the place of that of
/// another view. The pieces borrow from `document`, whose buffers must outlive them.
[[nodiscard]] BufferPieces replace_contents(Document& document, std::vector<ViewContent> contents,
                                            const std::vector<uint32_t>& aliased);

}  // namespace papilio::proto::gltf
