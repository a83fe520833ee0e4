#pragma once

#include <vector>

#include "papilio/mesh.h"

// Attributes that detail carries, in this order: texture coordinates (2 components); colours (3 components); part
// numbers (1 component, equal at all corners of a face). Levels have residuals of texture coordinates and colours.

namespace papilio {

/// Throws `Error` bad_option unless the attributes are some of those that detail carries.
void require_detail_attributes(const std::vector<Attribute>& attributes);
/// Throws `Error` bad_option if a face has corners in several parts. The attributes must pass
/// require_detail_attributes().
void require_whole_parts(const Mesh& mesh);

/// Returns whether attributes that detail carries include texture coordinates or colours.
[[nodiscard]] inline bool has_values(const std::vector<Attribute>& attributes) {
  return !attributes.empty() && attributes[0].components > 1;
}

}  // namespace papilio
