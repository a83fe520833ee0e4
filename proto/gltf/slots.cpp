#include "proto/gltf/slots.h"

#include <algorithm>
#include <utility>

#include "proto/gltf/byte_ranges.h"
#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint32_t array_buffer = 34962, element_array_buffer = 34963;  // targets of views

constexpr const char* type_names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};

/// Returns the bytes of an accessor in its view.
ByteRange range_in_view(const Json& accessor, const Json& view, uint32_t number) {
  const std::string where = place("accessors", number);
  const uint32_t size = element_format(accessor, where).bytes();
  const uint64_t begin = whole_number(accessor, "byteOffset", where, 0);
  const uint64_t count = whole_number(accessor, "count", where);
  const uint64_t stride = whole_number(view, "byteStride", "a view", size);
  const uint64_t length = whole_number(view, "byteLength", "a view");
  if (count == 0) return {begin, begin};
  if (stride == 0 || count > length / stride + 1) return {0, length};  // the accessor exceeds its view
  return {begin, begin + (count - 1) * stride + size};
}

/// Adds missing lists for new contents. Added later, they would invalidate references of callers.
std::vector<std::string> add_lists(Json& document) {
  std::vector<std::string> added;
  for (const char* list : {"accessors", "bufferViews"}) {
    if (document.contains(list)) continue;
    document[list] = Json::array();
    added.emplace_back(list);
  }
  return added;
}

}  // namespace

Slots::Slots(Document& document, Released released)
    : document_(document),
      json_(document.json),
      added_(add_lists(document.json)),
      released_(std::move(released)),
      old_accessors_(array_of(document.json, "accessors")),
      accessor_is_used_(released_.accessors.size()),
      view_is_used_(released_.views.size()) {
  compact_shared_views();
}

uint32_t Slots::take_accessor(const ElementSummary& elements) {
  const std::optional<uint32_t> old = elements.accessor;
  if (old) (void)element_of(json_, "accessors", *old, "a primitive");
  const bool reuses = old && *old < released_.accessors.size() && released_.accessors[*old] && !accessor_is_used_[*old];
  Json accessor = old ? old_accessors_[*old] : Json::object();
  for (const char* key : {"bufferView", "byteOffset", "sparse"}) accessor.erase(key);
  accessor["componentType"] = static_cast<uint32_t>(elements.format.type);
  if (!elements.format.normalized) accessor.erase("normalized");
  accessor["count"] = elements.count;
  if (!old) accessor["type"] = type_names[elements.format.components - 1];
  if (elements.bounds) {
    if (accessor.contains("min")) accessor["min"] = elements.bounds->first;
    if (accessor.contains("max")) accessor["max"] = elements.bounds->second;
  }
  if (reuses) {
    accessor_is_used_[*old] = true;
    json_["accessors"][*old] = std::move(accessor);
    return *old;
  }
  json_["accessors"].push_back(std::move(accessor));
  return static_cast<uint32_t>(json_["accessors"].size() - 1);
}

uint32_t Slots::take_view(std::optional<uint32_t> preferred, Use use) {
  const auto is_free = [&](size_t v) { return v < released_.views.size() && released_.views[v] && !view_is_used_[v]; };
  if (preferred && is_free(*preferred)) {
    view_is_used_[*preferred] = true;
    return *preferred;
  }
  Json view = Json::object();
  view["buffer"] = UINT32_MAX;  // set with its content
  view["byteLength"] = 0;
  if (preferred && *preferred < released_.views.size()) {
    const Json& like = json_["bufferViews"][*preferred];
    view["buffer"] = like["buffer"];
    if (like.contains("target")) view["target"] = use == Use::vertices ? array_buffer : element_array_buffer;
  }
  json_["bufferViews"].push_back(std::move(view));
  return static_cast<uint32_t>(json_["bufferViews"].size() - 1);
}

uint32_t Slots::put(EncodedElements elements, Use use) {
  const std::optional<uint32_t> old = elements.summary.accessor;
  const uint32_t accessor = take_accessor(elements.summary);
  const auto old_view = old ? index_member(old_accessors_[*old], "bufferView", place("accessors", *old)) : std::nullopt;
  ViewContent content = std::move(elements.content);
  content.view = take_view(old_view, use);
  json_["accessors"][accessor]["bufferView"] = content.view;
  contents_.push_back(std::move(content));
  return accessor;
}

uint32_t Slots::put_stream(std::optional<uint32_t> old, std::string stream) {
  const uint32_t view = take_view(old, Use::vertices);
  json_["bufferViews"][view].erase("target");
  ViewContent content;
  content.view = view;
  content.bytes = std::move(stream);
  contents_.push_back(std::move(content));
  return view;
}

void Slots::compact_shared_views() {
  const size_t count = released_.views.size();
  std::vector<std::vector<ByteRange>> removed(count), live(count);
  std::vector<std::vector<uint32_t>> users(count);
  const Json& accessors = old_accessors_;
  for (uint32_t a = 0; a < accessors.size(); ++a) {
    const auto view = index_member(accessors[a], "bufferView", place("accessors", a));
    if (!view || *view >= count || released_.views[*view] || !released_.views_of_accessors[*view]) continue;
    const ByteRange range = range_in_view(accessors[a], json_["bufferViews"][*view], a);
    (released_.accessors[a] ? removed : live)[*view].push_back(range);
    if (!released_.accessors[a]) users[*view].push_back(a);
  }
  Views views(document_);
  for (uint32_t v = 0; v < count; ++v) {
    if (removed[v].empty() || users[v].empty()) continue;
    const std::string_view bytes = views.bytes(v, place("bufferViews", v));
    const KeptBytes kept = keep_bytes(bytes.size(), std::move(removed[v]), std::move(live[v]), bytes);
    if (kept.size == bytes.size()) continue;
    const Json& view = json_["bufferViews"][v];
    const auto compressed = read_meshopt_view(view, place("bufferViews", v));
    ViewContent content;
    content.view = v;
    content.bytes.resize(kept.size);
    for (const KeptRange& range : kept.ranges)
      bytes.copy(&content.bytes[range.begin], range.old.end - range.old.begin, range.old.begin);
    content.strided = view.contains("byteStride");
    if (content.strided) content.stride = view["byteStride"].get<uint32_t>();
    if (compressed && compressed->mode == MeshoptMode::attributes) {
      content.compressed = true;
      content.stride = compressed->stride;
      content.bytes.resize((content.bytes.size() + content.stride - 1) / content.stride * content.stride);
    }
    for (const uint32_t a : users[v]) {
      const uint64_t offset = whole_number(accessors[a], "byteOffset", place("accessors", a), 0);
      json_["accessors"][a]["byteOffset"] = kept.moved(offset);
    }
    contents_.push_back(std::move(content));
  }
  old_accessors_ = json_["accessors"];
}

void Slots::decompress_rest() {
  Views views(document_);
  std::vector<bool> has_content(json_["bufferViews"].size());
  for (const ViewContent& content : contents_) has_content[content.view] = true;
  for (uint32_t v = 0; v < released_.views.size(); ++v) {
    const auto compressed = read_meshopt_view(json_["bufferViews"][v], place("bufferViews", v));
    if (!compressed || has_content[v] || released_.views[v]) continue;
    ViewContent content;
    content.view = v;
    content.bytes = views.bytes(v, place("bufferViews", v));
    content.stride = compressed->stride;
    content.strided = json_["bufferViews"][v].contains("byteStride");
    contents_.push_back(std::move(content));
  }
  for (ViewContent& content : contents_) content.compressed = false;
}

BufferPieces Slots::finish() {
  std::vector<uint32_t> aliased;
  for (uint32_t v = 0; v < released_.views.size(); ++v)
    if (released_.views[v] && !view_is_used_[v]) aliased.push_back(v);
  BufferPieces pieces = replace_contents(document_, std::move(contents_), aliased);
  for (const std::string& list : added_)
    if (json_[list].empty()) json_.erase(list);
  return pieces;
}

}  // namespace papilio::proto::gltf
