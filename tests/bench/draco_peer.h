#pragma once

#include <string>

#include "proto/draco_writer.h"
#include "tests/bench/openmesh_peer.h"

// A program that combines libdraco and OpenMesh.

namespace papilio::bench {

/// Decodes a stream of triangles with positions of floats. Throws std::runtime_error.
[[nodiscard]] PeerMesh decode_for_peer(const std::string& draco);
/// Encodes positions and faces with an explicit grid and the speed of the options. Throws std::runtime_error.
[[nodiscard]] std::string encode_for_peer(const PeerMesh& mesh, const proto::QuantizationBox& box,
                                          const proto::OutputOptions& options);

}  // namespace papilio::bench
