#pragma once

#include <functional>
#include <span>

#include "criteria/selection.h"
#include "hierarchy/hierarchy.h"
#include "hierarchy/memory_plan.h"
#include "hierarchy/progress.h"
#include "mesh/displacement.h"
#include "papilio/detail.h"

namespace papilio {

/// Tries the edges of a level of the hierarchy of `coarse`: with the vertices of its detail as far as it goes, below by
/// the rules (try_split). Throws `Error` cancelled, and what Detail::new_vertices() throws.
[[nodiscard]] Trial try_level(const HierarchyLevel& level, const Mesh& coarse, const Options& options,
                              const TrialContext& context, const std::function<bool()>& cancelled = {});

/// Adds the texture coordinates and colours that a detail gives the points on the half-edges of the whole level that
/// `number` levels give, if it does, to the last attributes of two components and of three that are no normals.
/// `parent`: as of Displacement. Throws `Error` as Detail::new_texcoords().
void add_values_of_detail(const Mesh& mesh, const Detail& detail, int number, std::span<const uint32_t> parent,
                          Displacements& displaced, const std::function<bool()>& cancelled = {});

/// Whole level of a mesh with detail.
struct DecodedSize {
  uint64_t faces = 0;
  uint64_t bytes = 0;  ///< taken while it is decoded
};
/// Returns the size of the level that `level` levels give.
[[nodiscard]] DecodedSize decoded_size(const Mesh& coarse, int level, const MemoryPlan& plan);

/// Returns the largest move of the levels of detail from `first` on (0 is that of the coarse edges), as far as the
/// options have levels and the limits room to decode them; 0 where there are none.
[[nodiscard]] double largest_move_below(const Mesh& coarse, int first, const Options& options, const MemoryPlan& plan,
                                        const Progress& progress);

}  // namespace papilio
