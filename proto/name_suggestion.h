#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace papilio::proto {

/// The name that was probably meant by `typed`, which none of `names` is: the nearest in edit distance (insertions,
/// deletions, substitutions and swaps of neighbours; Damerau 1964), of equally near ones the first. At most a third of
/// the name's characters may differ, and at most three. A name also stands for what follows its dot: "eye" is nearest
/// to "view.eye".
[[nodiscard]] std::optional<std::string_view> suggest_name(std::string_view typed,
                                                           std::span<const std::string_view> names);

}  // namespace papilio::proto
