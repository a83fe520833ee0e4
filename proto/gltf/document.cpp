#include "proto/gltf/document.h"

#include <algorithm>
#include <array>

#include "proto/draco_header.h"
#include "proto/gltf/data_uri.h"
#include "proto/gltf/extensions.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t most_buffers = 256;
constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

void require_version(const Json& document) {
  const Json* asset = find_member(document, "asset", "the JSON");
  if (asset == nullptr) refuse_document("the JSON", "has no asset, which names the version");
  std::string version = text_member(*asset, "minVersion", "asset");
  if (version.empty()) version = text_member(*asset, "version", "asset");
  if (version == "2.0" || (version.starts_with("2.") && !asset->contains("minVersion"))) return;
  throw Problem(Code::mesh_unsupported,
                "The document has glTF version " + quote(version) + "; 2.0 is supported. Export it as glTF 2.0.");
}

[[noreturn]] void refuse_newer_meshopt(const std::string& what) {
  throw Problem(Code::mesh_unsupported, what + " " + std::string(newer_meshopt_extension) +
                                            ", which cannot be read. Compress it with " +
                                            std::string(meshopt_extension) + ", or not at all.");
}

void require_extensions(const Json& document) {
  for (const Json& name : array_of(document, "extensionsRequired"))
    if (is_text(name, newer_meshopt_extension)) refuse_newer_meshopt("The scene requires");
  // A view that is readable without the extension would keep the compressed bytes of its old content.
  const Json& views = array_of(document, "bufferViews");
  for (size_t v = 0; v < views.size(); ++v)
    if (find_extension(views[v], newer_meshopt_extension, place("bufferViews", v)) != nullptr)
      refuse_newer_meshopt(place("bufferViews", v) + " has");
}

[[noreturn]] void refuse_external(const std::string& where, const std::string& uri) {
  throw Problem(Code::mesh_unsupported, where + " is in the file " + quote(uri) +
                                            ", which is not fetched. Send a .glb file, or embed the buffer in the "
                                            "document as a data URI.");
}

bool is_fallback(const Json& buffer, const std::string& where) {
  return find_extension(buffer, meshopt_extension, where) != nullptr;
}

std::string_view first_bytes(std::string_view bytes, uint64_t length, const std::string& where) {
  if (bytes.size() >= length) return bytes.substr(0, length);
  refuse_document(where,
                  "declares " + std::to_string(length) + " bytes, and there are " + std::to_string(bytes.size()));
}

SceneBuffer owned_buffer(BufferPlace kind, std::string bytes, uint64_t length, const std::string& where) {
  (void)first_bytes(bytes, length, where);
  bytes.resize(length);
  return {kind, std::move(bytes)};
}

SceneBuffer read_buffer(const Json& buffer, size_t number, const std::optional<std::string_view>& chunk,
                        const Resolver& resolve, Cut cut) {
  const std::string where = place("buffers", number);
  const uint64_t length = whole_number(buffer, "byteLength", where);
  const std::string uri = text_member(buffer, "uri", where);
  if (uri.empty()) {
    if (number == 0 && chunk) {
      const uint64_t needed = cut == Cut::refused ? length : std::min<uint64_t>(length, chunk->size());
      return {BufferPlace::binary_chunk, first_bytes(*chunk, needed, where)};
    }
    if (!is_fallback(buffer, where)) refuse_document(where, "has neither a uri nor a binary chunk");
    return {BufferPlace::fallback, std::string_view()};
  }
  if (is_data_uri(uri)) {
    std::optional<std::string> bytes = decode_data_uri(uri);
    if (!bytes) refuse_document(where, "has a data URI that is not valid base64");
    return owned_buffer(BufferPlace::data_uri, std::move(*bytes), length, where);
  }
  if (!resolve) refuse_external(where, uri);
  return owned_buffer(BufferPlace::external, resolve(uri), length, where);
}

bool find_uncompressed_views(const Document& document) {
  const Json& views = array_of(document.json, "bufferViews");
  for (size_t v = 0; v < views.size(); ++v) {
    const std::string where = place("bufferViews", v);
    if (find_extension(views[v], meshopt_extension, where) == nullptr) continue;
    const auto buffer = index_member(views[v], "buffer", where);
    if (buffer && *buffer < document.buffers.size() && document.buffers[*buffer].place() != BufferPlace::fallback)
      return true;
  }
  return false;
}

Document read(std::string_view bytes, const Resolver& resolve, Cut cut) {
  Document document;
  std::optional<std::string_view> chunk;
  document.is_glb = is_glb(bytes);
  if (document.is_glb) {
    Container container = read_glb(bytes, cut);
    document.json = parse_document(container.json);
    document.extra = std::move(container.extra);
    chunk = container.binary;
  } else {
    if (!looks_like_gltf(bytes))
      throw Problem(Code::mesh_not_gltf, "The bytes are neither a .glb file nor a glTF document. Provide one of them.");
    document.json = parse_document(bytes.starts_with(byte_order_mark) ? bytes.substr(byte_order_mark.size()) : bytes);
  }
  require_version(document.json);
  require_extensions(document.json);
  const Json& buffers = array_of(document.json, "buffers");
  require_within(buffers.size(), most_buffers, "buffers", "Export the scene with one buffer.");
  for (size_t i = 0; i < buffers.size(); ++i)
    document.buffers.push_back(read_buffer(buffers[i], i, chunk, resolve, cut));
  document.has_uncompressed_views = find_uncompressed_views(document);
  return document;
}

}  // namespace

bool looks_like_gltf(std::string_view bytes) {
  if (is_glb(bytes)) return true;
  if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
  const size_t first = bytes.find_first_not_of(blanks);
  return first != std::string_view::npos && bytes[first] == '{';
}

Document read_document(std::string_view bytes, const Resolver& resolve) { return read(bytes, resolve, Cut::refused); }

Document read_cut_document(std::string_view glb) {
  if (!is_glb(glb)) throw Problem(Code::mesh_not_gltf, "The bytes are not a .glb file. Provide one.");
  return read(glb, {}, Cut::in_binary_chunk);
}

}  // namespace papilio::proto::gltf
