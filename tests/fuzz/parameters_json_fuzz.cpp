#include "proto/parameters.h"
#include "tests/fuzz/fuzz.h"

// Any text as parameters in JSON: accepted parameters have an equivalent canonical form.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::unless_refused([&] {
    const proto::Parameters parameters = proto::parse_json(fuzz::text_of(data, size));
    fuzz::require(proto::parse_query(proto::to_fields(parameters)) == parameters, "the canonical form means the same");
  });
  return 0;
}
