#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace papilio::proto {

/// Returns the name nearest to `typed` in edit distance (insertions, deletions, substitutions, swaps of neighbours;
/// Damerau 1964), the first of equally near ones. The distance is at most a third of the name's length, and at most
/// three. The part of a name after its dot matches too: "eye" is nearest to "view.eye".
[[nodiscard]] std::optional<std::string_view> suggest_name(std::string_view typed,
                                                           std::span<const std::string_view> names);

}  // namespace papilio::proto
