#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "papilio/options.h"
#include "proto/draco_writer.h"
#include "proto/gltf/compression.h"
#include "proto/gltf/element_summary.h"
#include "proto/gltf/geometry.h"

// Primitives compressed by KHR_draco_mesh_compression.

namespace papilio::proto::gltf {

/// A decoded primitive.
struct DracoPrimitive {
  uint64_t count = 0;  ///< vertices
  std::vector<VertexStream> attributes;
  Buffer<Triangle> triangles;
};

/// Decodes a primitive. `extension`: its KHR_draco_mesh_compression; `attributes`: those of the primitive, whose
/// accessors give the formats. Throws `Problem`: as `read_draco`, and mesh_not_gltf where the stream and the accessors
/// disagree.
[[nodiscard]] DracoPrimitive read_draco_primitive(Views& views, const Json& extension, const Json& attributes,
                                                  const Limits& limits, const std::string& where);

/// A primitive's stream, and what decodes from it.
struct DracoContent {
  std::string stream;
  std::vector<std::pair<std::string, uint32_t>> ids;  ///< semantic and Draco's unique id
  std::vector<std::pair<std::string, ElementSummary>> attributes;
  ElementSummary indices;
};

/// Compresses a primitive. Vertices that no triangle uses and degenerate triangles are dropped. `indices`: accessor of
/// its old ones in the document. `box` quantizes the positions: one for all primitives of a mesh, so that their borders
/// stay closed. Throws `Problem`.
[[nodiscard]] DracoContent encode_draco_primitive(const Json& document, VertexSet set, Buffer<Triangle> triangles,
                                                  std::optional<uint32_t> indices, const QuantizationBox& box,
                                                  const OutputOptions& options, const std::function<void()>& poll = {});

/// Returns whether a primitive with these vertices is written as a Draco stream. Morph targets are not.
[[nodiscard]] bool becomes_draco(const Json& primitive, const VertexSet& set, Compression requested);

/// Returns an upper bound of the memory of `encode_draco_primitive`, with the streams and triangles that it reads.
[[nodiscard]] OutputBytes draco_bytes(const VertexSet& set);

}  // namespace papilio::proto::gltf
