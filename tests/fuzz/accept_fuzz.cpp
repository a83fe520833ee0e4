#include <algorithm>

#include "server/accept.h"
#include "tests/fuzz/fuzz.h"

// Any text as the Accept field: one of the offered formats is chosen.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::vector<std::string> offered{"application/x-draco", "multipart/mixed", "application/json"};
  const std::string_view accept = fuzz::text_of(data, size);
  const auto chosen = server::negotiate(accept, offered);
  fuzz::require(!chosen || std::ranges::find(offered, *chosen) != offered.end(), "it was offered");
  fuzz::require(chosen.has_value() || accept.find_first_not_of(", \t\r\n\v\f") != accept.npos,
                "nothing takes anything");
  return 0;
}
