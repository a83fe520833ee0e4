#include "proto/gltf/buffer_writer.h"

#include <algorithm>

#include "proto/gltf/byte_ranges.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/views.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t content_alignment = 8;
constexpr const char* mode_names[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};

Json* meshopt_member(Json& object) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return nullptr;
  const auto found = extensions->find(meshopt_extension);
  return found == extensions->end() ? nullptr : &*found;
}

/// Range of a view's bytes, or of its compressed bytes.
struct Stored {
  uint32_t buffer = 0;
  ByteRange range;
  Json* holder = nullptr;  ///< object with buffer and byteOffset
};

class BufferWriter {
 public:
  explicit BufferWriter(Document& document) : document_(document), json_(document.json) {
    if (!json_.contains("buffers")) json_["buffers"] = Json::array();
    cursor_.resize(json_["buffers"].size());
    pieces_.resize(cursor_.size());
  }

  BufferPieces run(std::vector<ViewContent> contents, const std::vector<uint32_t>& aliased) {
    is_replaced_.assign(json_.contains("bufferViews") ? json_["bufferViews"].size() : 0, false);
    for (const ViewContent& content : contents) is_replaced_[content.view] = true;
    for (const uint32_t view : aliased) is_replaced_[view] = true;
    for (uint32_t b = 0; b < cursor_.size(); ++b) keep(b);
    for (ViewContent& content : contents) append(content);
    for (const uint32_t view : aliased) alias(view, contents);
    for (uint32_t b = 0; b < cursor_.size(); ++b) json_["buffers"][b]["byteLength"] = cursor_[b];
    drop_unused_fallbacks();
    if (json_["buffers"].empty()) json_.erase("buffers");
    return std::move(pieces_);
  }

 private:
  [[nodiscard]] bool is_fallback(uint32_t buffer) const {
    return buffer >= document_.buffers.size() || document_.buffers[buffer].place() == BufferPlace::fallback;
  }

  std::vector<Stored> stored_in(uint32_t buffer, bool replaced) {
    std::vector<Stored> found;
    const auto add = [&](Json& holder) {
      const uint64_t offset = holder.value("byteOffset", uint64_t{0});
      if (holder.value("buffer", UINT32_MAX) == buffer)
        found.push_back({buffer, {offset, offset + holder.value("byteLength", uint64_t{0})}, &holder});
    };
    for (uint32_t v = 0; v < is_replaced_.size(); ++v) {
      Json& view = json_["bufferViews"][v];
      if (is_replaced_[v] != replaced || !view.contains("buffer")) continue;
      add(view);
      if (Json* compressed = meshopt_member(view)) add(*compressed);
    }
    return found;
  }

  /// Keeps the bytes of a buffer that are still needed, and moves the views of them.
  void keep(uint32_t buffer) {
    std::vector<ByteRange> live, removed;
    const std::vector<Stored> kept_views = stored_in(buffer, false);
    for (const Stored& stored : kept_views) live.push_back(stored.range);
    for (const Stored& stored : stored_in(buffer, true)) removed.push_back(stored.range);
    const bool has_bytes = !is_fallback(buffer);
    const std::string_view bytes = has_bytes ? document_.buffers[buffer].bytes() : std::string_view();
    const uint64_t size = has_bytes ? bytes.size() : json_["buffers"][buffer].value("byteLength", uint64_t{0});
    const KeptBytes kept = keep_bytes(size, std::move(removed), std::move(live), bytes);
    for (const Stored& stored : kept_views) {
      const uint64_t moved = kept.moved(stored.range.begin);
      if (moved != stored.range.begin) (*stored.holder)["byteOffset"] = moved;
    }
    for (const KeptRange& range : kept.ranges) {
      pad(buffer, range.begin);
      if (has_bytes) pieces_[buffer].push_back({bytes.substr(range.old.begin, range.old.end - range.old.begin)});
      cursor_[buffer] = range.begin + (range.old.end - range.old.begin);
    }
  }

  void pad(uint32_t buffer, uint64_t to) {
    if (to == cursor_[buffer]) return;
    if (!is_fallback(buffer)) pieces_[buffer].push_back({{}, std::string(to - cursor_[buffer], '\0')});
    cursor_[buffer] = to;
  }

  /// Appends bytes to a buffer, and returns their offset. `left_out`: bytes that a buffer of fallback sizes only
  /// counts.
  uint64_t append_bytes(uint32_t buffer, std::string bytes, uint64_t left_out = 0) {
    pad(buffer, (cursor_[buffer] + content_alignment - 1) / content_alignment * content_alignment);
    const uint64_t at = cursor_[buffer];
    cursor_[buffer] += bytes.size() + left_out;
    if (!is_fallback(buffer)) pieces_[buffer].push_back({{}, std::move(bytes)});
    return at;
  }

  uint32_t append_buffer(Json buffer, BufferPlace kind) {
    json_["buffers"].push_back(std::move(buffer));
    document_.buffers.emplace_back(kind, std::string_view());
    cursor_.push_back(0);
    pieces_.emplace_back();
    return static_cast<uint32_t>(cursor_.size() - 1);
  }

  /// Returns the buffer of `view` if it stores bytes, else the first that does.
  uint32_t data_buffer(const Json& view) {
    const uint32_t own = view.value("buffer", UINT32_MAX);
    if (own < document_.buffers.size() && !is_fallback(own)) return own;
    for (uint32_t b = 0; b < document_.buffers.size(); ++b)
      if (!is_fallback(b)) return b;
    const bool becomes_chunk = document_.is_glb && document_.buffers.empty();
    Json buffer{{"byteLength", 0}};
    if (!becomes_chunk) buffer["uri"] = "data:application/octet-stream;base64,";
    return append_buffer(std::move(buffer), becomes_chunk ? BufferPlace::binary_chunk : BufferPlace::data_uri);
  }

  uint32_t fallback_buffer() {
    for (uint32_t b = 0; b < document_.buffers.size(); ++b)
      if (is_fallback(b)) return b;
    return append_buffer({{"byteLength", 0}, {"extensions", {{meshopt_extension, {{"fallback", true}}}}}},
                         BufferPlace::fallback);
  }

  void append(ViewContent& content) {
    Json& view = json_["bufferViews"][content.view];
    view["byteLength"] = content.length();
    if (content.strided)
      view["byteStride"] = content.stride;
    else
      view.erase("byteStride");
    if (content.compressed) {
      append_compressed(view, content);
      return;
    }
    Json* compressed = meshopt_member(view);
    const uint32_t buffer = data_buffer(compressed != nullptr ? *compressed : view);
    erase_extension(view, meshopt_extension);
    place_view(view, buffer, std::move(content));
  }

  void place_view(Json& view, uint32_t buffer, ViewContent content) {
    view["buffer"] = buffer;
    view["byteOffset"] = append_bytes(buffer, std::move(content.bytes), content.left_out);
  }

  void append_compressed(Json& view, ViewContent& content) {
    Json* old = meshopt_member(view);
    const uint32_t source = data_buffer(old != nullptr ? *old : view);
    std::string bytes = content.encoded.empty() ? encode_meshopt(content) : std::move(content.encoded);
    Json extension{{"buffer", source}, {"byteOffset", 0}, {"byteLength", bytes.size()}, {"byteStride", content.stride}};
    extension["mode"] = mode_names[static_cast<size_t>(content.mode)];
    extension["count"] = content.length() / content.stride;
    extension["byteOffset"] = append_bytes(source, std::move(bytes));
    const bool has_own = old != nullptr && view.value("buffer", UINT32_MAX) < document_.buffers.size();
    const uint32_t buffer = has_own ? view["buffer"].get<uint32_t>() : fallback_buffer();
    view["extensions"][meshopt_extension] = std::move(extension);
    place_view(view, buffer, std::move(content));
  }

  /// Refers a view without content to the bytes of the first new content, or if there is none, of the first view.
  void alias(uint32_t number, const std::vector<ViewContent>& contents) {
    Json& view = json_["bufferViews"][number];
    erase_extension(view, meshopt_extension);
    for (const char* key : {"byteStride", "byteOffset"}) view.erase(key);
    const Json* source = contents.empty() ? nullptr : &json_["bufferViews"][contents[0].view];
    if (source != nullptr && source->contains("extensions")) source = find_extension(*source, meshopt_extension, "");
    if (source == nullptr) source = &json_["bufferViews"][contents.empty() ? first_kept_view() : contents[0].view];
    for (const char* key : {"buffer", "byteOffset", "byteLength"})
      if (source->contains(key)) view[key] = (*source)[key];
  }

  [[nodiscard]] size_t first_kept_view() const {
    const auto found = std::ranges::find(is_replaced_, false);
    return found == is_replaced_.end() ? 0 : static_cast<size_t>(found - is_replaced_.begin());
  }

  /// Removes unused buffers of fallback sizes at the end.
  void drop_unused_fallbacks() {
    while (!document_.buffers.empty() && is_fallback(static_cast<uint32_t>(document_.buffers.size() - 1))) {
      const auto last = static_cast<uint32_t>(document_.buffers.size() - 1);
      std::fill(is_replaced_.begin(), is_replaced_.end(), false);
      if (!stored_in(last, false).empty()) return;
      json_["buffers"].erase(last);
      document_.buffers.pop_back();
      pieces_.pop_back();
      cursor_.pop_back();
    }
  }

  Document& document_;
  Json& json_;
  std::vector<bool> is_replaced_;  ///< [views] whether the content is replaced
  std::vector<uint64_t> cursor_;   ///< [buffers] bytes so far
  BufferPieces pieces_;
};

}  // namespace

std::string encode_meshopt(const ViewContent& content) {
  return content.mode == MeshoptMode::attributes ? encode_meshopt_attributes(content.bytes, content.stride)
                                                 : encode_meshopt_triangles(content.bytes, content.stride);
}

BufferPieces replace_contents(Document& document, std::vector<ViewContent> contents,
                              const std::vector<uint32_t>& aliased) {
  return BufferWriter(document).run(std::move(contents), aliased);
}

}  // namespace papilio::proto::gltf
