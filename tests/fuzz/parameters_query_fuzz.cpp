#include "proto/parameters.h"
#include "tests/fuzz/fuzz.h"

// Any fields of a query, as name=value&name=value: accepted parameters have an equivalent
// canonical form.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  proto::QueryFields fields;
  for (std::string_view text = fuzz::text_of(data, size); !text.empty();) {
    const auto [field, rest] = fuzz::cut(text, '&');
    const auto [name, value] = fuzz::cut(field, '=');
    fields.emplace_back(name, value);
    text = rest;
  }
  fuzz::unless_refused([&] {
    const proto::Parameters parameters = proto::parse_query(fields);
    fuzz::require(proto::parse_query(proto::to_fields(parameters)) == parameters, "the canonical form means the same");
  });
  return 0;
}
