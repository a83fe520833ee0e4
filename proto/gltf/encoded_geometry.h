#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "proto/draco_writer.h"
#include "proto/gltf/buffer_writer.h"
#include "proto/gltf/compression.h"
#include "proto/gltf/draco_primitive.h"
#include "proto/gltf/element_summary.h"
#include "proto/gltf/geometry.h"

// New triangles of a mesh, encoded for the document's buffers. A mesh is encoded before the next is refined, so that
// only one is in memory unencoded.

namespace papilio::proto::gltf {

/// New triangles of a mesh: sets and primitives as of read_geometry(), with new contents.
struct NewGeometry {
  uint32_t mesh = 0;
  MeshGeometry geometry;
  QuantizationBox box;  ///< grid of positions compressed by Draco
};

struct GeometryEncoding {
  Compression compression = Compression::same;
  OutputOptions draco;
  std::function<void()> poll;  ///< called regularly; may throw to stop
};

/// Elements of an accessor and their bytes.
struct EncodedElements {
  ElementSummary summary;
  ViewContent content;  ///< content, without the number of its view
};

/// Attribute of vertices.
struct EncodedStream {
  std::string semantic;
  EncodedElements elements;
};

/// Vertices of primitives without Draco.
struct EncodedSet {
  std::vector<EncodedStream> attributes;
  std::vector<std::vector<EncodedStream>> targets;  ///< by morph target
};

struct EncodedPrimitive {
  uint32_t number = 0;                ///< index in its mesh
  uint32_t set = 0;                   ///< index of its vertices in EncodedGeometry::sets
  std::optional<DracoContent> draco;  ///< Draco stream; nothing if it has the vertices of the set, and indices
  EncodedElements indices;
};

struct EncodedGeometry {
  uint32_t mesh = 0;
  std::vector<EncodedSet> sets;  ///< vertices; a set is empty if Draco compresses all of its primitives
  std::vector<EncodedPrimitive> primitives;

  /// Returns the bytes of all contents.
  [[nodiscard]] uint64_t bytes() const;
};

/// Encodes new triangles of a mesh of the document, and frees arrays of `mesh` once they are read. Throws `Problem`.
[[nodiscard]] EncodedGeometry encode_geometry(const Document& document, NewGeometry mesh,
                                              const GeometryEncoding& encoding);

}  // namespace papilio::proto::gltf
