#pragma once

#include <vector>

#include "papilio/mesh.h"

// Attributes that detail carries: texture coordinates, of two components, and behind them the numbers of parts, one
// component, the same at the corners of each face.

namespace papilio {

/// Throws `Error` bad_option unless the attributes are none, or one or both of these.
void require_detail_attributes(const std::vector<Attribute>& attributes);
/// Throws `Error` bad_option where a face has corners in several parts. The attributes must be such ones.
void require_whole_parts(const Mesh& mesh);

/// Whether there are texture coordinates among such attributes; they come first.
[[nodiscard]] inline bool has_texcoords(const std::vector<Attribute>& attributes) {
  return !attributes.empty() && attributes[0].components == 2;
}

}  // namespace papilio
