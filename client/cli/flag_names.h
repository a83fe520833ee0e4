#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace papilio::client {

/// Returns a long flag, "--view.edge-pixels" or "--crease-angle=30", under its known name, which may differ in `-`,
/// `_` and `.`: "--view.edge_pixels", "--crease_angle=30". `names` have no leading dashes. Other arguments are returned
/// unchanged.
[[nodiscard]] std::string known_flag(const std::string& argument, const std::vector<std::string>& names);

/// Returns the message for an argument that a command does not take: the nearest flag, or where to find help.
/// `command`: its name as called, such as "papilio refine".
[[nodiscard]] std::string unexpected_argument(const std::string& argument, const std::string& command,
                                              const std::vector<std::string>& names);

}  // namespace papilio::client
