#pragma once

#include <functional>

#include "criteria/selection.h"
#include "hierarchy/hierarchy.h"

namespace papilio {

/// Tries the edges of a level of the hierarchy of `coarse`: with the vertices of its detail as far as it goes, below by
/// the rules (try_split). Throws `Error` cancelled, and what Detail::new_vertices() throws.
[[nodiscard]] Trial try_level(const HierarchyLevel& level, const Mesh& coarse, const Options& options,
                              const TrialContext& context, const std::function<bool()>& cancelled = {});

}  // namespace papilio
