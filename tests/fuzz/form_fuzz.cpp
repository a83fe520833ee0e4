#include "server/http/form.h"
#include "tests/fuzz/fuzz.h"

// The first line as Content-Type, the rest as the body of a form.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto [content_type, body] = fuzz::cut(fuzz::text_of(data, size), '\n');
  fuzz::unless_refused([&, type = content_type, text = body] {
    size_t bytes = 0;
    for (const server::FormPart& part : server::parse_form(type, text)) {
      fuzz::require(!part.name.empty(), "every part has a name");
      fuzz::require(text.find(part.bytes) != text.npos, "a part's bytes are the body's");
      bytes += part.bytes.size();
    }
    fuzz::require(bytes <= text.size(), "parts do not overlap");
  });
  return 0;
}
