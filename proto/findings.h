#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::proto {

/// Counts with their names in headers and JSON.
using Findings = std::vector<std::pair<std::string_view, uint32_t>>;

/// Returns all counts of a report, zeros included.
[[nodiscard]] Findings all_findings(const BuildReport& report);

/// Returns the nonzero counts of defects, repaired ones included. Points of equal position and boundaries are no
/// defects.
[[nodiscard]] Findings defects(const BuildReport& report);

/// Formats the defects as a header value: "non_manifold_edges=2, pinched_vertices=1", or "" for none.
[[nodiscard]] std::string defects_text(const BuildReport& report);
/// Parses the text of `defects_text`. Ignores unknown names.
[[nodiscard]] BuildReport parse_defects(std::string_view text);

}  // namespace papilio::proto
