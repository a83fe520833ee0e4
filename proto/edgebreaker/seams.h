#pragma once

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/output_attribute.h"

namespace papilio::proto::edgebreaker {

/// Seams of an attribute: inner edges whose two faces have different values at a common vertex.
struct Seams {
  Buffer<uint8_t> is_seam;  ///< [corners] whether the edge opposite to the corner is a seam; empty: no seams
  Buffer<uint32_t> value;   ///< [corners] index of each corner's value
  [[nodiscard]] bool empty() const { return is_seam.empty(); }
};
/// Finds the seams of an attribute. `corner_point` [corners]: the point at each corner.
[[nodiscard]] Seams find_seams(const CornerMesh& mesh, const Buffer<uint32_t>& corner_point,
                               const OutputAttribute& attribute);

/// Cuts the surface open along an attribute's seams: a vertex becomes one vertex for each fan between two seams.
[[nodiscard]] CornerMesh cut_open(const CornerMesh& mesh, const Seams& seams);

}  // namespace papilio::proto::edgebreaker
