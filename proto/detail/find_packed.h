#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "papilio/options.h"
#include "proto/detail/packed_model.h"
#include "proto/limits.h"

// Packed models where a mesh or a scene is expected.

namespace papilio::proto::detail {

/// Reads a packed model with all levels that can be refined; nothing for other bytes, and for a scene with the
/// extension that is no packed model (mesh_unsupported): of that the base alone is used. Residuals are not decoded.
/// Throws `Problem` as `read_packed`.
[[nodiscard]] std::optional<PackedModel> find_packed(std::string_view bytes, const Limits& limits);

/// Attaches the levels of a packed model to its base, whose texture coordinates count downwards. Throws `Error` as
/// `Mesh::attach_detail`.
void attach_levels(Mesh& base, PackedModel model);
/// Attaches them to a base whose texture coordinates are turned over (packed_texcoords.h).
void attach_levels_turned_over(Mesh& base, PackedModel model);

/// Where levels follow from a target (`Options::stop_at_limits`), ends them with those of the mesh's detail: the finest
/// is the surface against which the target is held.
void end_with_detail(Options& options, const Mesh& mesh);

}  // namespace papilio::proto::detail
