#include "proto/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "proto/gltf/extensions.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr std::array<std::pair<std::string_view, MeshoptMode>, 3> modes{{{"ATTRIBUTES", MeshoptMode::attributes},
                                                                         {"TRIANGLES", MeshoptMode::triangles},
                                                                         {"INDICES", MeshoptMode::indices}}};
constexpr uint64_t largest_stride = 256;
/// Upper bound of the compression ratio: the vertex codec takes at least 4 bytes for 256 bytes of a column, and the
/// index codecs one byte for 3 indices of 4 bytes.
constexpr uint64_t largest_ratio = 64;
constexpr uint64_t block_vertices = 256;
constexpr unsigned vertex_header = 0xA0, triangle_header = 0xE0, sequence_header = 0xD0;

const unsigned char* bytes_at(std::string_view text) { return reinterpret_cast<const unsigned char*>(text.data()); }

unsigned known_header(MeshoptMode mode) {
  if (mode == MeshoptMode::attributes) return vertex_header;
  return mode == MeshoptMode::triangles ? triangle_header : sequence_header;
}

/// Returns the newest version of the codec that the library reads.
unsigned newest_version(MeshoptMode mode) { return mode == MeshoptMode::attributes ? 0 : 1; }

void require_codec(const MeshoptView& view, std::string_view compressed, const std::string& where) {
  const unsigned header = compressed.empty() ? 0 : static_cast<unsigned char>(compressed[0]);
  if ((header & 0xF0U) == known_header(view.mode) && (header & 0xFU) > newest_version(view.mode))
    throw Problem(Code::mesh_unsupported, where + " is compressed with version " + std::to_string(header & 0xFU) +
                                              " of the meshopt codec; version " +
                                              std::to_string(newest_version(view.mode)) +
                                              " is supported. Compress it for " + meshopt_extension + ".");
}

void check_format(const MeshoptView& view, const std::string& where) {
  const bool is_index = view.mode != MeshoptMode::attributes;
  const bool is_sound = is_index ? view.stride == 2 || view.stride == 4
                                 : view.stride % 4 == 0 && view.stride > 0 && view.stride <= largest_stride;
  if (!is_sound)
    refuse_document(where, "has the byteStride " + std::to_string(view.stride) + ", which its mode forbids");
  if (view.mode == MeshoptMode::triangles && view.count % 3 != 0)
    refuse_document(where, "has " + std::to_string(view.count) + " indices of triangles, which is no multiple of 3");
  const auto& filter = view.filter;
  const bool fits =
      filter == "NONE" || (!is_index && ((filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) ||
                                         (filter == "QUATERNION" && view.stride == 8) || filter == "EXPONENTIAL"));
  if (!fits) refuse_document(where, "has the filter " + quote(filter) + ", which its mode and byteStride do not allow");
}

int decode_into(const MeshoptView& view, std::string_view compressed, std::string& out) {
  const unsigned char* bytes = bytes_at(compressed);
  switch (view.mode) {
    case MeshoptMode::attributes:
      return meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, bytes, compressed.size());
    case MeshoptMode::triangles:
      return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, compressed.size());
    case MeshoptMode::indices:
      break;
  }
  return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, compressed.size());
}

void apply_filter(const MeshoptView& view, std::string& out) {
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.stride);
}

}  // namespace

std::optional<MeshoptView> read_meshopt_view(const Json& view, const std::string& where) {
  if (find_extension(view, newer_meshopt_extension, where) != nullptr)
    throw Problem(Code::mesh_unsupported, where + " is compressed by " + std::string(newer_meshopt_extension) +
                                              ", which cannot be read. Compress it with " + meshopt_extension + ".");
  const Json* extension = find_extension(view, meshopt_extension, where);
  if (extension == nullptr) return std::nullopt;
  const std::string inner = where + ".extensions." + meshopt_extension;
  MeshoptView found;
  const auto buffer = index_member(*extension, "buffer", inner);
  if (!buffer) refuse_document(inner, "has no buffer");
  found.buffer = *buffer;
  found.offset = whole_number(*extension, "byteOffset", inner, 0);
  found.length = whole_number(*extension, "byteLength", inner);
  const uint64_t stride = whole_number(*extension, "byteStride", inner);
  found.stride = stride > largest_stride ? 0 : static_cast<uint32_t>(stride);
  found.count = whole_number(*extension, "count", inner);
  const std::string mode = text_member(*extension, "mode", inner);
  const auto* known = modes.begin();
  while (known != modes.end() && known->first != mode) ++known;
  if (known == modes.end()) refuse_document(inner, "has the unknown mode " + quote(mode));
  found.mode = known->second;
  if (extension->contains("filter")) found.filter = text_member(*extension, "filter", inner);
  check_format(found, inner);
  return found;
}

std::string decode_meshopt(const MeshoptView& view, std::string_view compressed, const std::string& where) {
  require_codec(view, compressed, where);
  if (view.count / block_vertices > compressed.size() ||
      view.count * view.stride > largest_ratio * compressed.size() + block_vertices * view.stride)
    refuse_document(where, "declares " + std::to_string(view.count) + " elements, more than its " +
                               std::to_string(compressed.size()) + " compressed bytes can hold");
  std::string out(view.count * view.stride, '\0');
  if (view.count > 0 && decode_into(view, compressed, out) != 0)
    refuse_document(where, "has damaged data of " + std::string(meshopt_extension));
  apply_filter(view, out);
  return out;
}

std::string encode_meshopt_attributes(std::string_view elements, uint32_t stride) {
  const size_t count = elements.size() / stride;
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), elements.data(),
                                        count, stride));
  out.shrink_to_fit();  // the bound is above the size of the elements
  return out;
}

std::string encode_meshopt_triangles(std::string_view indices, uint32_t stride) {
  std::vector<unsigned> numbers(indices.size() / stride);
  unsigned largest = 0;
  for (size_t i = 0; i < numbers.size(); ++i) {
    for (uint32_t byte = 0; byte < stride; ++byte)
      numbers[i] |= unsigned{static_cast<unsigned char>(indices[i * stride + byte])} << (8 * byte);
    largest = std::max(largest, numbers[i]);
  }
  std::string out(meshopt_encodeIndexBufferBound(numbers.size(), size_t{largest} + 1), '\0');
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), numbers.data(),
                                       numbers.size()));
  out.shrink_to_fit();
  return out;
}

}  // namespace papilio::proto::gltf
