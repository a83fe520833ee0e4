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

/// Computes the new vertices of the edges of a level of the hierarchy of `coarse`: from its detail on levels that it
/// has, else by the rules (try_split). Throws `Error` cancelled, and errors of Detail::new_vertices().
[[nodiscard]] Trial try_level(const HierarchyLevel& level, const Mesh& coarse, const Options& options,
                              const TrialContext& context, const std::function<bool()>& cancelled = {});

/// Adds the texture coordinates and colours of a detail, if it has any, for the points on the half-edges of the whole
/// level after `number` levels. They belong to the last attributes of 2 and of 3 components that are not normals.
/// `parent`: `Displacement::parent`. Throws `Error` as Detail::new_texcoords().
void add_values_of_detail(const Mesh& mesh, const Detail& detail, int number, std::span<const uint32_t> parent,
                          Displacements& displaced, const std::function<bool()>& cancelled = {});

/// Size of a whole level of a mesh with detail.
struct DecodedSize {
  uint64_t faces = 0;
  uint64_t bytes = 0;  ///< bytes taken while it is decoded
};
/// Returns the size of the mesh after `level` levels.
[[nodiscard]] DecodedSize decoded_size(const Mesh& coarse, int level, const MemoryPlan& plan);

/// Returns the largest move of the levels of detail from `first` on, where 0 splits the coarse edges. Counts levels
/// within the options' levels and limits only; 0 if there are none.
[[nodiscard]] double largest_move_below(const Mesh& coarse, int first, const Options& options, const MemoryPlan& plan,
                                        const Progress& progress);

}  // namespace papilio
