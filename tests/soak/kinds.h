#pragma once

#include <vector>

#include "tests/soak/client.h"

namespace papilio::soak {

/// Kind of client: its action in a turn, and the number of such clients.
struct Kind {
  const char* name;
  int clients;
  void (*turn)(Client&);
};

[[nodiscard]] std::vector<Kind> decent_kinds();  ///< one-shot refinements, in every form
[[nodiscard]] std::vector<Kind> stored_kinds();  ///< stored meshes, their views and revalidation
[[nodiscard]] std::vector<Kind> wrong_kinds();   ///< requests that must be refused, each with its status
[[nodiscard]] std::vector<Kind> rude_kinds();    ///< clients that disconnect, stall or violate HTTP

}  // namespace papilio::soak
