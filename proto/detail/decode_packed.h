#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "proto/detail/packed_model.h"
#include "proto/mesh_format.h"

namespace papilio::proto::detail {

struct DecodeOptions {
  uint64_t face_limit = face_count_limit;
  std::optional<NormalStyle> normals{};  ///< style of the result's normals; nothing: style of the original
  std::function<bool()> cancelled{};     ///< polled regularly; true stops with `Fault::cancelled`
};

/// Decodes a packed model with its texture coordinates, which count upwards as in other meshes, its colours, and
/// normals of the decoded surface (packed_normals.h). Each face of the base becomes equally many consecutive faces.
/// Throws `Error` as decode_detail().
[[nodiscard]] FormattedMesh decode_packed(const PackedModel& model, const DecodeOptions& options = {});

}  // namespace papilio::proto::detail
