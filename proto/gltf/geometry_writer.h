#pragma once

#include <vector>

#include "proto/gltf/encoded_geometry.h"

namespace papilio::proto::gltf {

/// Puts new triangles in place of those of their primitives. Accessors and views keep their places: new contents take
/// those of the old ones, or of none, where others need the old ones. Primitives become indexed lists of triangles.
/// What the old geometry alone held is removed from the buffers, and so are the residuals of a packed model
/// (PAPILIO_detail); everything else survives. `compression`: the one that the meshes were encoded with; `none`
/// decompresses all other views too. Returns the bytes of the buffers, which borrow from `document`. Throws `Problem`.
[[nodiscard]] BufferPieces write_geometry(Document& document, std::vector<EncodedGeometry> meshes,
                                          Compression compression);

/// Removes the residuals of packed models alone: their bases stay as they are. Returns and throws as `write_geometry`.
[[nodiscard]] BufferPieces remove_detail(Document& document);

}  // namespace papilio::proto::gltf
