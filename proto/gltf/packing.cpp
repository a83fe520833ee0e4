#include "proto/gltf/packing.h"

#include <algorithm>
#include <array>
#include <optional>

#include "proto/gltf/data_uri.h"
#include "proto/gltf/document_writer.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/views.h"

namespace papilio::proto::gltf {
namespace {

/// File name extensions of images that a view may contain, and their media types.
constexpr std::array<std::pair<std::string_view, const char*>, 5> image_types{{{".png", "image/png"},
                                                                               {".jpg", "image/jpeg"},
                                                                               {".jpeg", "image/jpeg"},
                                                                               {".webp", "image/webp"},
                                                                               {".ktx2", "image/ktx2"}}};

const char* find_image_type(std::string uri) {
  std::ranges::transform(uri, uri.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (const auto& [end, type] : image_types)
    if (uri.ends_with(end)) return type;
  return nullptr;
}

/// Returns the media type and the bytes of an external or embedded image; nothing for an unknown type or a missing
/// file.
std::optional<std::pair<std::string, std::string>> image_of(const std::string& uri, const ImageFinder& find_image) {
  if (is_data_uri(uri)) {
    auto bytes = decode_data_uri(uri);
    if (!bytes) return std::nullopt;
    constexpr size_t scheme = 5;  // "data:"
    return std::pair(uri.substr(scheme, uri.find_first_of(";,") - scheme), std::move(*bytes));
  }
  const char* type = find_image_type(uri);
  if (type == nullptr) return std::nullopt;
  auto bytes = find_image(uri);
  if (!bytes) return std::nullopt;
  return std::pair(type, std::move(*bytes));
}

/// Returns the contents of new views for the images without a view.
std::vector<ViewContent> pack_images(Document& document, const ImageFinder& find_image) {
  std::vector<ViewContent> contents;
  const size_t count = array_of(document.json, "images").size();
  for (size_t i = 0; i < count; ++i) {
    Json& image = document.json["images"][i];
    const std::string uri = text_member(image, "uri", place("images", i));
    auto read = uri.empty() ? std::nullopt : image_of(uri, find_image);
    if (!read) continue;
    ViewContent content;
    content.bytes = std::move(read->second);
    content.view = static_cast<uint32_t>(array_of(document.json, "bufferViews").size());
    document.json["bufferViews"].push_back({{"buffer", UINT32_MAX}, {"byteLength", 0}});
    Json& packed = document.json["images"][i];
    packed.erase("uri");
    packed["mimeType"] = read->first;
    packed["bufferView"] = content.view;
    contents.push_back(std::move(content));
  }
  return contents;
}

/// Moves a view, or its compressed range, from its old buffer to the new one.
void move_to_buffer(Json& holder, const std::vector<std::pair<uint32_t, uint64_t>>& moved) {
  const auto& [buffer, offset] = moved[holder["buffer"].get<size_t>()];
  holder["buffer"] = buffer;
  if (offset > 0) holder["byteOffset"] = holder.value("byteOffset", uint64_t{0}) + offset;
}

/// Returns whether both buffers have extras, or both have extensions, so that they cannot be joined.
bool have_conflicting_members(const Json& buffer, const Json& other) {
  return std::ranges::any_of(std::array{"extras", "extensions"},
                             [&](const char* key) { return buffer.contains(key) && other.contains(key); });
}

/// Joins the buffers with bytes into the first, which becomes the binary chunk. Buffers with conflicting members are
/// embedded in the document. `owners` receives the buffers that the pieces borrow from.
BufferPieces join_buffers(Document& document, BufferPieces pieces, std::vector<SceneBuffer>& owners) {
  constexpr uint64_t alignment = 8;
  std::vector<std::pair<uint32_t, uint64_t>> moved;  // new buffer, and offset of the old one in it
  BufferPieces joined(1);
  Json buffers = Json::array({Json::object()});
  std::vector<SceneBuffer> places{{BufferPlace::binary_chunk, std::string_view()}};
  uint64_t size = 0;
  for (size_t b = 0; b < pieces.size(); ++b) {
    Json& buffer = document.json["buffers"][b];
    if (document.buffers[b].place() == BufferPlace::fallback) {
      moved.emplace_back(static_cast<uint32_t>(buffers.size()), 0);
      buffers.push_back(std::move(buffer));
      places.emplace_back(BufferPlace::fallback, std::string_view());
      joined.emplace_back();
      continue;
    }
    buffer.erase("uri");
    if (have_conflicting_members(buffer, buffers[0])) {
      moved.emplace_back(static_cast<uint32_t>(buffers.size()), 0);
      buffers.push_back(std::move(buffer));
      places.emplace_back(BufferPlace::data_uri, std::string_view());
      joined.push_back(std::move(pieces[b]));
      continue;
    }
    const uint64_t begin = (size + alignment - 1) / alignment * alignment;
    if (begin > size) joined[0].push_back({{}, std::string(begin - size, '\0')});
    size = begin + buffer["byteLength"].get<uint64_t>();
    moved.emplace_back(0, begin);
    for (Piece& piece : pieces[b]) joined[0].push_back(std::move(piece));
    for (auto& [key, value] : buffer.items())
      buffers[0].emplace(key, std::move(value));  // members of earlier buffers are kept
  }
  buffers[0]["byteLength"] = size;
  if (document.json.contains("bufferViews"))
    for (Json& view : document.json["bufferViews"]) {
      move_to_buffer(view, moved);
      if (find_extension(view, meshopt_extension, "a view") != nullptr)
        move_to_buffer(view["extensions"][meshopt_extension], moved);
    }
  document.json["buffers"] = std::move(buffers);
  owners = std::exchange(document.buffers, std::move(places));
  return joined;
}

bool has_bytes(const Document& document) {
  return std::ranges::any_of(document.buffers,
                             [](const SceneBuffer& buffer) { return buffer.place() != BufferPlace::fallback; });
}

}  // namespace

std::string pack_scene(std::string_view gltf, const FileResolver& resolve, const ImageFinder& find_image) {
  if (is_glb(gltf)) return std::string(gltf);
  Document document = read_document(gltf, resolve);
  document.is_glb = true;  // the kind of the result
  require_sound_views(document);
  BufferPieces pieces = replace_contents(document, pack_images(document, find_image), {});
  if (!has_bytes(document)) return write_document(document, std::move(pieces), FileKind::glb).document;
  std::vector<SceneBuffer> owners;
  pieces = join_buffers(document, std::move(pieces), owners);
  return write_document(document, std::move(pieces), FileKind::glb).document;
}

UnpackedScene unpack_scene(std::string_view glb, const std::string& binary_name) {
  Document document = read_document(glb);
  SceneFiles files = write_document(document, unchanged_pieces(document), FileKind::gltf, binary_name);
  return {std::move(files.document), std::move(files.buffers)};
}

}  // namespace papilio::proto::gltf
