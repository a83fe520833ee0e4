#pragma once

#include <vector>

#include "proto/gltf/encoded_geometry.h"

namespace papilio::proto::gltf {

/// Replaces the triangles of primitives, which become indexed lists. New contents take accessors and views of the old
/// ones; old ones with other users are kept, and new ones are appended. Bytes that only the old geometry used are
/// removed from the buffers, and so are the residuals of a packed model (PAPILIO_detail). Everything else is kept.
///
/// `compression`: compression of the encoded meshes; `none` decompresses all other views too. Returns the bytes of the
/// buffers, which borrow from `document`. Throws `Problem`.
[[nodiscard]] BufferPieces write_geometry(Document& document, std::vector<EncodedGeometry> meshes,
                                          Compression compression);

/// Removes the residuals of packed models, and keeps their bases. Returns and throws as write_geometry().
[[nodiscard]] BufferPieces remove_detail(Document& document);

}  // namespace papilio::proto::gltf
