#pragma once

#include <functional>
#include <string>
#include <vector>

#include "papilio/mesh.h"
#include "proto/draco_writer.h"

namespace papilio::proto::detail {

/// Mesh as Draco streams, one for each of its parts (mesh_parts.h).
struct PartStreams {
  std::vector<std::string> streams;  ///< streams in the order of part numbers
  TriangleMesh decoded;              ///< decoded parts, joined

  [[nodiscard]] uint64_t bytes() const;
};

/// Codes and decodes a mesh with attributes of base_format(). All parts share the grid of positions, so that their
/// borders fit. `poll` is called regularly; it may throw to stop. Throws `Problem`.
[[nodiscard]] PartStreams write_parts(const Mesh& mesh, const QuantizationBox& grid, const OutputOptions& options,
                                      const std::function<void()>& poll = {});

}  // namespace papilio::proto::detail
