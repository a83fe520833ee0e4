#pragma once

#include <vector>

#include "papilio/mesh.h"

// Attributes that detail carries, in this order: texture coordinates, of two components; colours, of three; the numbers
// of parts, one component, the same at the corners of each face. Levels have residuals of the first two.

namespace papilio {

/// Throws `Error` bad_option unless the attributes are some of these.
void require_detail_attributes(const std::vector<Attribute>& attributes);
/// Throws `Error` bad_option where a face has corners in several parts. The attributes must be such ones.
void require_whole_parts(const Mesh& mesh);

/// Whether there are texture coordinates or colours among such attributes.
[[nodiscard]] inline bool has_values(const std::vector<Attribute>& attributes) {
  return !attributes.empty() && attributes[0].components > 1;
}

}  // namespace papilio
