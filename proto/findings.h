#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::proto {

/// Counts by their names on the wire.
using Findings = std::vector<std::pair<std::string_view, uint32_t>>;

/// All that was found in a mesh, zeros included.
[[nodiscard]] Findings all_findings(const BuildReport& report);

/// Only what had to be dropped or worked round, and only what there is: neither welded points nor boundaries, which are
/// common.
[[nodiscard]] Findings defects(const BuildReport& report);

/// The defects as a header field's value: "non_manifold_edges=2, pinched_vertices=1", empty when there are none; and
/// back (unknown names are passed over).
[[nodiscard]] std::string defects_text(const BuildReport& report);
[[nodiscard]] BuildReport parse_defects(std::string_view text);

}  // namespace papilio::proto
