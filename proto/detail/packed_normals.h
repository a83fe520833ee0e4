#pragma once

#include <optional>
#include <string_view>

#include "papilio/detail.h"
#include "proto/mesh_format.h"

// Normals of packed models: the file names the style of the original's normals, and readers compute normals of the
// decoded surface.

namespace papilio::proto::detail {

/// Returns the name of a style in the file; "" for none.
[[nodiscard]] std::string_view name_of(NormalStyle style);
/// Returns the style of a name; nothing for other text.
[[nodiscard]] std::optional<NormalStyle> normal_style_named(std::string_view name);

/// Returns the first normals of 3 components; nothing if there are none.
[[nodiscard]] std::optional<Attribute> normals_to_pack(const FormattedMesh& mesh);

}  // namespace papilio::proto::detail
