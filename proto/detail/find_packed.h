#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "papilio/options.h"
#include "proto/detail/packed_model.h"
#include "proto/limits.h"

// Recognition of packed models in requests for a mesh or a scene.

namespace papilio::proto::detail {

/// Reads a packed model with all levels that can be refined, without decoding residuals. Returns nothing for other
/// bytes, and for a scene with the extension that is no packed model (mesh_unsupported), of which only the base is
/// used. Throws `Problem` as read_packed().
[[nodiscard]] std::optional<PackedModel> find_packed(std::string_view bytes, const Limits& limits);

/// Attaches the levels of a packed model to its base, whose texture coordinates count downwards. Throws `Error` as
/// Mesh::attach_detail().
void attach_levels(Mesh& base, PackedModel model);
/// Attaches the levels of a packed model to a base whose texture coordinates are turned over (packed_texcoords.h).
void attach_levels_turned_over(Mesh& base, PackedModel model);

/// Limits `Options::levels` to the levels of the mesh's detail if they follow from a target
/// (`Options::stop_at_limits`): the finest level is the surface with which the target is compared.
void end_with_detail(Options& options, const Mesh& mesh);

}  // namespace papilio::proto::detail
