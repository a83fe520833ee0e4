#include <algorithm>

#include "server/http/body.h"
#include "server/http/head.h"
#include "tests/fuzz/fuzz.h"

// Any text as the head of a request: an accepted head contains nothing that could break a log or a header.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  server::Head head;
  fuzz::unless_refused([&] {
    server::parse_head(fuzz::text_of(data, size), head);
    const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    fuzz::require(server::is_token(head.method), "the method is a token");
    fuzz::require(std::ranges::none_of(head.path, is_control), "the path holds no control character");
    fuzz::require(std::ranges::none_of(head.target, is_control), "the target holds no control character");
    for (const auto& [name, value] : head.fields) {
      fuzz::require(server::is_token(name), "a field's name is a token");
      fuzz::require(value.find_first_of(std::string_view("\r\n\0", 3)) == value.npos, "a field is one line");
    }
    server::refuse_unreadable(head, server::framing_of(head), 1 << 20);
  });
  return 0;
}
