#pragma once

#include <cstdint>
#include <vector>

#include "base/poller.h"
#include "detail/collapse_sequence.h"
#include "detail/edge_middles.h"
#include "detail/original_surface.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Place on the original.
struct OriginalPlace {
  uint32_t face = 0;
  Vec3f point{};
};

/// Decoded base, with the places on the original that correspond to its dyadic points.
struct LiftedBase {
  Mesh mesh;                                       ///< mesh with edges, creases, corners, and attributes if any
  std::vector<uint32_t> seams;                     ///< edges at which charts of the attributes meet
  std::vector<FaceMatch> faces;                    ///< [F] faces in the sequence
  std::vector<uint32_t> vertex;                    ///< [V] numbers in the original
  std::vector<std::vector<OriginalPlace>> places;  ///< [level][E] places of the new vertices
};

/// Matches the vertices and faces of the decoded base with those of `base`, and lifts the new vertices of `levels`
/// levels. Throws `Error` bad_surface if the coder moved vertices onto others.
[[nodiscard]] LiftedBase lift_base(const CollapseSequence& sequence, const BaseMesh& base, const CodedBase& coded,
                                   const OriginalSurface& original, int levels, const Poller& poller);

}  // namespace papilio
