#pragma once

#include <functional>
#include <vector>

#include "proto/draco_writer.h"
#include "proto/gltf/buffer_writer.h"
#include "proto/gltf/compression.h"
#include "proto/gltf/geometry.h"

namespace papilio::proto::gltf {

/// New triangles of a mesh: sets and primitives as `read_geometry` gives them, with other contents.
struct NewGeometry {
  uint32_t mesh = 0;
  MeshGeometry geometry;
  QuantizationBox box;  ///< grid of positions where Draco compresses them
};

struct GeometryEncoding {
  Compression compression = Compression::same;
  OutputOptions draco;
  std::function<void()> poll;  ///< called now and then; may throw to stop
};

/// Puts new triangles in place of those of their primitives. Accessors and views keep their places: new contents take
/// those of the old ones, or of none, where others need the old ones. Primitives become indexed lists of triangles.
/// What the old geometry alone held is removed from the buffers, and so are the residuals of a packed model
/// (PAPILIO_detail); everything else survives. Returns the bytes of the buffers, which borrow from `document`. Throws
/// `Problem`.
[[nodiscard]] BufferPieces write_geometry(Document& document, std::vector<NewGeometry> meshes,
                                          const GeometryEncoding& encoding);

/// Removes the residuals of packed models alone: their bases stay as they are. Returns and throws as `write_geometry`.
[[nodiscard]] BufferPieces remove_detail(Document& document);

}  // namespace papilio::proto::gltf
