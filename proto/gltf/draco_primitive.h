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

/// Decoded primitive.
struct DracoPrimitive {
  uint64_t count = 0;  ///< number of vertices
  std::vector<VertexStream> attributes;
  Buffer<Triangle> triangles;
};

/// Decodes a primitive. `extension`: its KHR_draco_mesh_compression. `attributes`: attributes of the primitive, whose
/// accessors define the formats. Throws `Problem` as read_draco(), and mesh_not_gltf if stream and accessors differ.
[[nodiscard]] DracoPrimitive read_draco_primitive(Views& views, const Json& extension, const Json& attributes,
                                                  const Limits& limits, const std::string& where);

/// Stream of a primitive, and a description of its decoded attributes.
struct DracoContent {
  std::string stream;
  std::vector<std::pair<std::string, uint32_t>> ids;  ///< semantic and Draco's unique id
  std::vector<std::pair<std::string, ElementSummary>> attributes;
  ElementSummary indices;
};

/// Compresses a primitive. Drops unused vertices and degenerate triangles. `indices`: accessor of its old indices in
/// the document. `box` quantizes positions; it must be equal for all primitives of a mesh, so that their borders stay
/// closed. Throws `Problem`.
[[nodiscard]] DracoContent encode_draco_primitive(const Json& document, VertexSet set, Buffer<Triangle> triangles,
                                                  std::optional<uint32_t> indices, const QuantizationBox& box,
                                                  const OutputOptions& options, const std::function<void()>& poll = {});

/// Returns whether a primitive with these vertices is written as a Draco stream; false with morph targets.
[[nodiscard]] bool becomes_draco(const Json& primitive, const VertexSet& set, Compression requested);

/// Returns an upper bound of the memory of encode_draco_primitive(), including its input.
[[nodiscard]] OutputBytes draco_bytes(const VertexSet& set);

}  // namespace papilio::proto::gltf
