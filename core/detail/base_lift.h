#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detail/collapse_sequence.h"
#include "detail/edge_middles.h"
#include "detail/original_surface.h"
#include "papilio/mesh.h"

namespace papilio {

/// Place on the original.
struct OriginalPlace {
  uint32_t face = 0;
  Vec3f point{};
};

/// A base as its decoder has it, with the places on the original that its dyadic points correspond to.
struct LiftedBase {
  Mesh mesh;                                       ///< with edges, creases and corners, and attributes if any
  std::vector<uint32_t> seams;                     ///< edges at which charts of the attributes meet
  std::vector<FaceMatch> faces;                    ///< [F] in the sequence
  std::vector<uint32_t> vertex;                    ///< [V] number in the original
  std::vector<std::vector<OriginalPlace>> places;  ///< by level, of its new vertices [E]
};

/// Finds the vertices and faces of `base` in what its coder made of it, and lifts the new vertices of `levels` levels.
/// Throws `Error` bad_surface where the coder moved vertices too far.
[[nodiscard]] LiftedBase lift_base(const CollapseSequence& sequence, const BaseMesh& base, const TriangleMesh& decoded,
                                   const OriginalSurface& original, int levels, const std::function<void()>& poll);

}  // namespace papilio
