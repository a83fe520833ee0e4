#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace papilio::client {

/// A long flag, "--view.edge-pixels" or "--crease-angle=30", under the one of the known `names` (without dashes in
/// front) that is the same but for `-`, `_` and `.`: "--view.edge_pixels", "--crease_angle=30". All else as it is.
[[nodiscard]] std::string known_flag(const std::string& argument, const std::vector<std::string>& names);

/// What to say against an argument that a command does not take: a flag's nearest name, or where to look.
/// `command` is its name as it is called, "papilio refine".
[[nodiscard]] std::string unexpected_argument(const std::string& argument, const std::string& command,
                                              const std::vector<std::string>& names);

}  // namespace papilio::client
