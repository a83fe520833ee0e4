#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "proto/detail/packed_model.h"
#include "proto/mesh_format.h"

namespace papilio::proto::detail {

struct DecodeOptions {
  uint64_t face_limit = face_count_limit;
  std::optional<NormalStyle> normals{};  ///< those of the result; nothing: as the original's
  std::function<bool()> cancelled{};     ///< asked now and then; true stops with `Fault::cancelled`
};

/// Decodes a packed model with its texture coordinates, which count upwards as those of other meshes, its colours, and
/// normals of the decoded surface (packed_normals.h). Each face of the base is as many faces in a row. Throws `Error`
/// as decode_detail().
[[nodiscard]] FormattedMesh decode_packed(const PackedModel& model, const DecodeOptions& options = {});

}  // namespace papilio::proto::detail
