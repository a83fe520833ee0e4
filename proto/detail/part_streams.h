#pragma once

#include <functional>
#include <string>
#include <vector>

#include "papilio/mesh.h"
#include "proto/draco_writer.h"

namespace papilio::proto::detail {

/// A mesh as Draco streams, one for each of its parts (mesh_parts.h).
struct PartStreams {
  std::vector<std::string> streams;  ///< by the numbers of the parts
  TriangleMesh decoded;              ///< of all, joined

  [[nodiscard]] uint64_t bytes() const;
};

/// Codes a mesh whose other attributes are texture coordinates or normals (packed_texcoords.h), all parts on one grid
/// of positions, so that their borders fit, and decodes it. `poll` is called now and then; it may throw to stop. Throws
/// `Problem`.
[[nodiscard]] PartStreams write_parts(const Mesh& mesh, const OutputOptions& options,
                                      const std::function<void()>& poll = {});

}  // namespace papilio::proto::detail
