#pragma once

#include "mesh/part.h"
#include "papilio/mesh.h"
#include "rules/features.h"
#include "rules/tension.h"

// The butterfly (butterfly.h) where every edge is split and w is 0: the same to the bit, and several times as fast.
// `positions` [V] are an `Buffer`'s (vec3fa.h); `features` are those of the level; the new vertex of each edge is
// written to `made` [E]; of edges that touch a vertex at a cut nothing is known. Up to so many threads work on it.
// O(F).

namespace papilio {

void uniform_butterfly(const Topology& topology, const Features& features, const Vec3f* positions, Vec3f* made,
                       const TensionField* tension = nullptr, int threads = 1);

/// The same, without tension, for the level below `parents` (split_in_four.h), four faces at once (child_stencil.h).
/// `topology` of that level may be null where `features.are_rings()`: then nothing of it is needed. `asked_of`, if not
/// null, are the parents whose children are asked about: of edges that have other faces, too, nothing is known.
void uniform_butterfly_below(const Topology& parents, const Topology* topology, const Features& features,
                             const Vec3f* positions, Vec3f* made, int threads = 1,
                             const Buffer<uint32_t>* asked_of = nullptr);

/// The same of what split_part_in_four() makes of the parents, whose features are rings: of the edges between its
/// faces.
void uniform_butterfly_below(const Topology& parents, const Part& part, const Features& features_of_parents,
                             const Vec3f* positions, Vec3f* made, int threads = 1);

}  // namespace papilio
