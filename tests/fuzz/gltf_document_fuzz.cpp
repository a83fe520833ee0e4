#include "proto/gltf/document_writer.h"
#include "tests/fuzz/fuzz.h"

// Any bytes as a .glb or .gltf file: what is read can be written as either, and is equal when read again.

using namespace papilio;
using namespace papilio::proto::gltf;

namespace {

void require_equal(const Document& a, const Document& b) {
  fuzz::require(a.buffers.size() == b.buffers.size(), "buffers survive");
  for (size_t i = 0; i < a.buffers.size(); ++i)
    fuzz::require(a.buffers[i].bytes() == b.buffers[i].bytes(), "bytes of buffers survive");
}

void round_trip(std::string_view bytes) {
  Document document = read_document(bytes);
  const Document original = document;
  const std::string glb = write_document(document, unchanged_pieces(document), FileKind::glb).document;
  Document from_glb = read_document(glb);
  require_equal(original, from_glb);
  const SceneFiles text = write_document(from_glb, unchanged_pieces(from_glb), FileKind::gltf);
  const auto resolve = [&](const std::string& uri) {
    for (const auto& [name, content] : text.buffers)
      if (name == uri) return content;
    fuzz::require(false, "each buffer has its file");
    return std::string();
  };
  require_equal(original, read_document(text.document, resolve));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)fuzz::unless_refused([&] { round_trip(fuzz::text_of(data, size)); });
  return 0;
}
