#pragma once

#include <draco/core/encoder_buffer.h>

#include <span>
#include <vector>

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/pace.h"
#include "proto/edgebreaker/seams.h"

namespace papilio::proto::edgebreaker {

/// How the symbols of the walk are coded.
enum class Traversal : uint8_t {
  standard = 0,  ///< bits, by their frequency in any mesh
  valence = 2,   ///< entropy coding in the context of the valence to come: smaller, and slower
};

/// Walks over all faces, one that touches those before after another, and writes how they touch: Draco's bitstream
/// specification, edgebreaker connectivity; and for each attribute beside the positions which edges are its seams.
/// Returns the corner at which the walk came to each face, in the order in which a decoder meets them. [faces] The mesh
/// is lent: afterwards it is as it was. O(F log F) at worst, O(F) on usual meshes. `pace` steps once a face.
[[nodiscard]] Buffer<uint32_t> write_connectivity(CornerMesh& mesh, Traversal traversal,
                                                  std::span<const Seams> attributes, Pace& pace,
                                                  draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
