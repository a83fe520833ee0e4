#pragma once

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/output_attribute.h"

namespace papilio::proto::edgebreaker {

/// Where an attribute has more values than the mesh has vertices.
struct Seams {
  Buffer<uint8_t> is_seam;  ///< [corners] at the edge opposite to each, whose faces have other values there; or empty
  Buffer<uint32_t> value;   ///< [corners] the number of each corner's value
  [[nodiscard]] bool empty() const { return is_seam.empty(); }
};
[[nodiscard]] Seams find_seams(const CornerMesh& mesh, const Topology& topology, const Buffer<uint32_t>& corner_point,
                               const OutputAttribute& attribute);

/// The surface cut open along an attribute's seams: each vertex is what lies between two of them.
[[nodiscard]] CornerMesh cut_open(const CornerMesh& mesh, const Seams& seams);

}  // namespace papilio::proto::edgebreaker
