#include "proto/gltf/document_writer.h"

#include "proto/gltf/data_uri.h"

namespace papilio::proto::gltf {
namespace {

std::string joined(std::vector<Piece> pieces) {
  if (pieces.size() == 1 && !pieces[0].owned.empty()) return std::move(pieces[0].owned);
  size_t size = 0;
  for (const Piece& piece : pieces) size += piece.bytes().size();
  std::string bytes;
  bytes.reserve(size);
  for (Piece& piece : pieces) {
    bytes += piece.bytes();
    std::string().swap(piece.owned);
  }
  return bytes;
}

std::string uri_of(const Json& buffer) { return buffer.value("uri", std::string()); }

SceneFiles write_binary(Document& document, BufferPieces pieces) {
  std::optional<std::vector<Piece>> chunk;
  for (size_t b = 0; b < pieces.size(); ++b) {
    Json& buffer = document.json["buffers"][b];
    if (document.buffers[b].place() == BufferPlace::fallback) continue;
    if (b == 0) {
      chunk = std::move(pieces[b]);
      buffer.erase("uri");
    } else {
      buffer["uri"] = encode_data_uri(joined(std::move(pieces[b])), uri_of(buffer));
    }
  }
  return {write_glb(document.json.dump(), std::move(chunk), document.extra)};
}

SceneFiles write_text(Document& document, BufferPieces pieces, const std::string& binary_name) {
  SceneFiles files;
  for (size_t b = 0; b < pieces.size(); ++b) {
    Json& buffer = document.json["buffers"][b];
    const BufferPlace kind = document.buffers[b].place();
    if (kind == BufferPlace::fallback) continue;
    std::string bytes = joined(std::move(pieces[b]));
    if (kind == BufferPlace::data_uri) {
      buffer["uri"] = encode_data_uri(bytes, uri_of(buffer));
      continue;
    }
    if (kind == BufferPlace::binary_chunk) buffer["uri"] = binary_name;
    files.buffers.emplace_back(uri_of(buffer), std::move(bytes));
  }
  constexpr int indentation = 2;
  files.document = document.json.dump(indentation) + "\n";
  return files;
}

}  // namespace

BufferPieces unchanged_pieces(const Document& document) {
  BufferPieces pieces;
  for (const SceneBuffer& buffer : document.buffers) pieces.push_back({{buffer.bytes()}});
  return pieces;
}

SceneFiles write_document(Document& document, BufferPieces pieces, FileKind kind, const std::string& binary_name) {
  if (kind == FileKind::glb) return write_binary(document, std::move(pieces));
  return write_text(document, std::move(pieces), binary_name);
}

}  // namespace papilio::proto::gltf
