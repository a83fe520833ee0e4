#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "proto/detail/packed_model.h"
#include "proto/mesh_format.h"

// Texture coordinates of packed models. They count downwards there, as glTF's do, and upwards in other meshes.

namespace papilio::proto::detail {

/// Returns the format of a base's attributes: of none, or of texture coordinates.
[[nodiscard]] MeshFormat base_format(const TriangleMesh& base);

/// Returns the first texture coordinates of two components, as packed models have them; nothing where there are none.
[[nodiscard]] std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh);

/// Turns texture coordinates from packed models' to other meshes' direction, or back.
void turn_over(Attribute& texcoords);

/// Decodes a packed model with its texture coordinates, as other meshes have them. Throws `Error` as decode_detail().
[[nodiscard]] FormattedMesh decode_packed(const PackedModel& model, uint64_t face_limit = face_count_limit,
                                          const std::function<bool()>& cancelled = {});

}  // namespace papilio::proto::detail
