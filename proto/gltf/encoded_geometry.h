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

// New triangles of a mesh as they will lie in the document's buffers. A mesh is encoded before the next one is refined,
// so that one at a time is in memory as the core has it.

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

/// Elements of an accessor and their bytes.
struct EncodedElements {
  ElementSummary summary;
  ViewContent content;  ///< without its view
};

/// An attribute of vertices.
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
  uint32_t number = 0;                ///< in its mesh
  uint32_t set = 0;                   ///< its vertices in EncodedGeometry::sets
  std::optional<DracoContent> draco;  ///< nothing: it has the vertices of the set, and indices
  EncodedElements indices;
};

struct EncodedGeometry {
  uint32_t mesh = 0;
  std::vector<EncodedSet> sets;  ///< one is empty where Draco compresses all of its primitives
  std::vector<EncodedPrimitive> primitives;

  /// Returns the bytes of all contents.
  [[nodiscard]] uint64_t bytes() const;
};

/// Encodes new triangles of a mesh of the document, whose arrays are freed as they are read. Throws `Problem`.
[[nodiscard]] EncodedGeometry encode_geometry(const Document& document, NewGeometry mesh,
                                              const GeometryEncoding& encoding);

}  // namespace papilio::proto::gltf
