#pragma once

#include <vector>

#include "tests/soak/client.h"

namespace papilio::soak {

/// A kind of client: what it does in a turn, and how many there are.
struct Kind {
  const char* name;
  int clients;
  void (*turn)(Client&);
};

[[nodiscard]] std::vector<Kind> decent_kinds();  ///< one-shot refinements, in every form
[[nodiscard]] std::vector<Kind> stored_kinds();  ///< stored meshes, their views and revalidation
[[nodiscard]] std::vector<Kind> wrong_kinds();   ///< requests that must be refused, each with its status
[[nodiscard]] std::vector<Kind> rude_kinds();    ///< those who leave, stall, or send what is no HTTP

}  // namespace papilio::soak
