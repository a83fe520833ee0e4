#include <algorithm>

#include "proto/multipart.h"
#include "tests/fuzz/fuzz.h"

// The first byte as the size of chunks, a line as Content-Type, the rest as the body of an answer: the result does not
// depend on the chunks.

using namespace papilio;

namespace {

std::vector<proto::BodyPart> read(std::string_view type, std::string_view body, size_t piece, bool& refused) {
  std::vector<proto::BodyPart> parts;
  refused = !fuzz::unless_refused([&] {
    proto::MultipartReader reader(type, 1 << 16, [&](proto::BodyPart part) { parts.push_back(std::move(part)); });
    for (; !body.empty(); body.remove_prefix(std::min(piece, body.size()))) reader.feed(body.substr(0, piece));
    reader.finish();
  });
  return parts;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const auto [type, body] = fuzz::cut(fuzz::text_of(data + 1, size - 1), '\n');
  bool refused_whole = false;
  bool refused_in_pieces = false;
  const std::vector<proto::BodyPart> whole = read(type, body, size, refused_whole);
  const std::vector<proto::BodyPart> pieces = read(type, body, 1 + data[0], refused_in_pieces);
  const auto same = [](const proto::BodyPart& a, const proto::BodyPart& b) {
    return a.headers == b.headers && a.body == b.body;
  };
  fuzz::require(refused_whole == refused_in_pieces, "it is refused whole or in pieces");
  fuzz::require(std::ranges::equal(whole, pieces, same), "it is the same whole or in pieces");
  return 0;
}
