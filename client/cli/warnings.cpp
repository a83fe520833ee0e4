#include <algorithm>
#include <iostream>

#include "client/cli/commands.h"
#include "proto/text.h"

namespace papilio::client {

void print_warnings(const std::vector<std::string>& warnings) {
  constexpr size_t most = 10;
  std::string text;
  for (size_t i = 0; i < std::min(warnings.size(), most); ++i)
    text += "warning: " + proto::escape_controls(warnings[i]) + '\n';
  if (warnings.size() > most) text += "warning: and " + std::to_string(warnings.size() - most) + " more\n";
  std::cerr << text << std::flush;
}

}  // namespace papilio::client
