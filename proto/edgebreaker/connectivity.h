#pragma once

#include <draco/core/encoder_buffer.h>

#include <span>
#include <vector>

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/poller.h"
#include "proto/edgebreaker/seams.h"

namespace papilio::proto::edgebreaker {

/// Coding of the symbols of the walk.
enum class Traversal : uint8_t {
  standard = 0,  ///< fixed bits by symbol
  valence = 2,   ///< entropy coding in valence contexts: smaller and slower
};

/// Walks over all faces and writes the connectivity (Draco's bitstream specification, edgebreaker) and the seams of
/// each attribute. Returns the corner at which the walk entered each face, in decoding order. [faces] The mesh is
/// modified during the walk and restored afterwards. O(F log F) in the worst case, O(F) on usual meshes. `poller` steps
/// once a face.
[[nodiscard]] Buffer<uint32_t> write_connectivity(CornerMesh& mesh, Traversal traversal,
                                                  std::span<const Seams> attributes, Poller& poller,
                                                  draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
