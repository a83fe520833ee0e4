#include <iostream>

#include "client/cli/commands.h"

namespace papilio::client {

void health_command(const HealthFlags& flags) {
  std::cout << Remote(flags.server, flags.remote).health(flags.ready ? Health::ready : Health::alive) << '\n';
}

}  // namespace papilio::client
