#include "server/http/chunk_line.h"

#include <algorithm>

#include "tests/fuzz/fuzz.h"

// Any text as the line before a chunk: an accepted line contains no byte that another parser could take for its end.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view line = fuzz::text_of(data, size);
  fuzz::unless_refused([&] {
    (void)server::chunk_size(line);
    const auto is_control = [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; };
    fuzz::require(std::ranges::none_of(line, is_control), "an accepted line holds no control character");
  });
  return 0;
}
