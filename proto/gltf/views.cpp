#include "proto/gltf/views.h"

#include "proto/gltf/meshopt.h"
#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

void require_inside(uint64_t offset, uint64_t length, uint64_t size, const std::string& where, const std::string& of) {
  if (offset > size || length > size - offset)
    refuse_document(where, "has the bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
                               " of " + of + ", which has " + std::to_string(size));
}

std::string_view bytes_in_buffer(const Document& document, const ViewRange& range, const std::string& where) {
  if (range.buffer >= document.buffers.size())
    refuse_document(where, "refers to " + place("buffers", range.buffer) + ", which does not exist");
  const SceneBuffer& buffer = document.buffers[range.buffer];
  if (buffer.place() == BufferPlace::fallback && range.length > 0)
    refuse_document(where, "lies in " + place("buffers", range.buffer) + ", which has no data");
  require_inside(range.offset, range.length, buffer.bytes().size(), where, place("buffers", range.buffer));
  return buffer.bytes().substr(range.offset, range.length);
}

}  // namespace

ViewRange view_range(const Document& document, uint64_t view, const std::string& where) {
  const Json& json = element_of(document.json, "bufferViews", view, where);
  const std::string name = place("bufferViews", view);
  const auto buffer = index_member(json, "buffer", name);
  if (!buffer) refuse_document(name, "has no buffer");
  const ViewRange range{*buffer, whole_number(json, "byteOffset", name, 0), whole_number(json, "byteLength", name)};
  const Json& of = element_of(document.json, "buffers", range.buffer, name);
  const std::string buffer_name = place("buffers", range.buffer);
  require_inside(range.offset, range.length, whole_number(of, "byteLength", buffer_name), name, buffer_name);
  return range;
}

void require_sound_views(const Document& document) {
  const size_t count = array_of(document.json, "bufferViews").size();
  for (size_t v = 0; v < count; ++v) {
    const std::string name = place("bufferViews", v);
    (void)view_range(document, v, "bufferViews");
    const auto compressed = read_meshopt_view(document.json["bufferViews"][v], name);
    if (compressed) (void)bytes_in_buffer(document, {compressed->buffer, compressed->offset, compressed->length}, name);
  }
}

std::string_view Views::bytes(uint64_t view, const std::string& where) {
  if (const auto known = decoded_.find(view); known != decoded_.end()) return known->second;
  const ViewRange range = view_range(document_, view, where);
  const std::string name = place("bufferViews", view);
  const auto compressed = read_meshopt_view(document_.json["bufferViews"][view], name);
  if (!compressed) return bytes_in_buffer(document_, range, name);
  if (compressed->count > most_decoded_bytes || compressed->count * compressed->stride != range.length)
    refuse_document(name, "has byteLength " + std::to_string(range.length) + ", but " +
                              std::to_string(compressed->count) + " elements of " + std::to_string(compressed->stride) +
                              " bytes");
  require_room(range.length);
  const std::string_view source =
      bytes_in_buffer(document_, {compressed->buffer, compressed->offset, compressed->length}, name);
  return decoded_.emplace(view, decode_meshopt(*compressed, source, name)).first->second;
}

void Views::require_room(uint64_t more) {
  if (more > most_decoded_bytes - decoded_bytes_)
    throw Problem(Code::mesh_too_large, "The geometry of the scene exceeds " + std::to_string(most_decoded_bytes) +
                                            " bytes once it is decoded. Send a coarser scene, or part of it.");
  decoded_bytes_ += more;
}

}  // namespace papilio::proto::gltf
