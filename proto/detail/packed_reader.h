#pragma once

#include <string_view>

#include "proto/detail/packed_model.h"
#include "proto/limits.h"

namespace papilio::proto::detail {

struct ReadOptions {
  Limits limits{};
  size_t levels = most_detail_levels;  ///< upper bound of the levels to read
  /// Whether the file may be a prefix that ends inside the bytes of a level. Its whole levels are read, and the whole
  /// pieces of the cut level.
  bool may_be_cut = false;
};

/// Returns whether the bytes are a .glb file with the extension PAPILIO_detail on a primitive. Reads the JSON alone.
/// Bytes that are no .glb file are not packed.
[[nodiscard]] bool is_packed(std::string_view glb);

/// Reads a packed model (proto/detail.md). Decodes the base, which must be manifold, but not the residuals.
/// `limits.max_output_faces` bounds the faces of the last level that is read, before any stream is decoded. Throws
/// `Problem`: mesh_not_gltf (damaged, truncated, a member out of range), mesh_unsupported (no packed model, another
/// version, a scene that the format does not allow), mesh_too_large, mesh_unusable (a base that is not manifold),
/// result_too_large; and errors of read_draco().
[[nodiscard]] PackedModel read_packed(std::string_view glb, const ReadOptions& options = {});

}  // namespace papilio::proto::detail
