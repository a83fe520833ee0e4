#pragma once

#include <span>

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/output_attribute.h"

namespace papilio::proto::edgebreaker {

/// Seams of an attribute: inner edges whose two faces have different values at a common vertex.
struct Seams {
  Buffer<uint8_t> is_seam;  ///< [corners] whether the edge opposite to the corner is a seam; empty: no seams
  [[nodiscard]] bool empty() const { return is_seam.empty(); }
};
/// Finds the seams of an attribute. `corner_point` [corners]: the point at each corner.
[[nodiscard]] Seams find_seams(const CornerMesh& mesh, const Buffer<uint32_t>& corner_point,
                               const OutputAttribute& attribute);

/// Returns how many points a decoder makes of the vertices: one for each part of a vertex's fan between edges at which
/// any attribute has two values there. A single seam that ends at a vertex does not divide it.
[[nodiscard]] uint32_t decoded_points(const CornerMesh& mesh, std::span<const Seams> attributes);

/// Cuts the surface open along an attribute's seams: a vertex becomes one vertex for each fan between two seams.
[[nodiscard]] CornerMesh cut_open(const CornerMesh& mesh, const Seams& seams);

}  // namespace papilio::proto::edgebreaker
