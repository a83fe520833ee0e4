#include "proto/gltf/container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "papilio/buffer.h"
#include "proto/freed_memory.h"
#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

constexpr std::string_view glb_magic = "glTF";
constexpr size_t header_bytes = 12;
constexpr size_t chunk_header_bytes = 8;
constexpr uint32_t glb_version = 2;
constexpr uint32_t json_chunk = 0x4E4F534A;
constexpr uint32_t binary_chunk = 0x004E4942;
constexpr uint64_t freed_at_once = 4 * worth_giving_back;  ///< bytes of pieces freed before memory is returned

uint32_t little_endian(std::string_view bytes, size_t at) {
  uint32_t number = 0;
  for (size_t i = 0; i < 4; ++i) number |= uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return number;
}

void append_little_endian(std::string& bytes, uint64_t number) {
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFF);
}

[[noreturn]] void refuse_glb(const std::string& what) {
  throw Problem(Code::mesh_not_gltf, what + " Provide the whole .glb file, or export it again.");
}

uint64_t padded(uint64_t bytes) { return (bytes + 3) / 4 * 4; }

void require_header(std::string_view bytes, Cut cut) {
  if (!is_glb(bytes)) refuse_glb("The bytes do not begin with glTF.");
  if (bytes.size() < header_bytes + chunk_header_bytes)
    refuse_glb("The .glb file has " + std::to_string(bytes.size()) + " bytes; at least 20 are required.");
  if (const uint32_t version = little_endian(bytes, 4); version != glb_version)
    throw Problem(Code::mesh_unsupported, "The .glb file has version " + std::to_string(version) +
                                              "; only version 2 is supported. Export it as glTF 2.0.");
  if (const uint32_t length = little_endian(bytes, 8);
      length != bytes.size() && (cut == Cut::refused || length < bytes.size()))
    refuse_glb("The .glb header declares " + std::to_string(length) + " bytes, and there are " +
               std::to_string(bytes.size()) + ".");
}

void append_padding(std::string& out, uint64_t bytes, char pad) { out.append(padded(bytes) - bytes, pad); }

}  // namespace

bool is_glb(std::string_view bytes) { return bytes.starts_with(glb_magic); }

Container read_glb(std::string_view bytes, Cut cut) {
  require_header(bytes, cut);
  Container found;
  bool has_json = false;
  for (size_t at = header_bytes; at < bytes.size();) {
    if (bytes.size() - at < chunk_header_bytes)
      refuse_glb("The .glb file ends inside the header of a chunk, at byte " + std::to_string(at) + ".");
    uint64_t length = little_endian(bytes, at);
    const uint32_t type = little_endian(bytes, at + 4);
    at += chunk_header_bytes;
    if (cut == Cut::in_binary_chunk && type == binary_chunk) length = std::min<uint64_t>(length, bytes.size() - at);
    if (length > bytes.size() - at)
      refuse_glb("A chunk at byte " + std::to_string(at) + " declares " + std::to_string(length) + " bytes, and " +
                 std::to_string(bytes.size() - at) + " are left.");
    const std::string_view content = bytes.substr(at, length);
    at += length;
    if (!has_json) {
      if (type != json_chunk) refuse_glb("The first chunk of the .glb file is not JSON.");
      found.json = content;
      has_json = true;
    } else if (type == json_chunk || (type == binary_chunk && (found.binary || !found.extra.empty()))) {
      refuse_glb("The .glb file has a second JSON chunk, or a BIN chunk that is not the second chunk.");
    } else if (type == binary_chunk) {
      found.binary = content;
    } else {
      found.extra.push_back({type, content});
    }
  }
  return found;
}

std::string write_glb(std::string_view json, std::optional<std::vector<Piece>> binary,
                      const std::vector<ExtraChunk>& extra) {
  uint64_t binary_bytes = 0;
  if (binary)
    for (const Piece& piece : *binary) binary_bytes += piece.bytes().size();
  uint64_t total = header_bytes + chunk_header_bytes + padded(json.size());
  if (binary) total += chunk_header_bytes + padded(binary_bytes);
  for (const ExtraChunk& chunk : extra) total += chunk_header_bytes + padded(chunk.bytes.size());
  if (total > UINT32_MAX)
    throw Problem(Code::result_too_large, "The result has " + std::to_string(total) +
                                              " bytes; a .glb file has at most 4294967295. Request fewer levels.");
  std::string out;
  out.reserve(total);
  out += glb_magic;
  append_little_endian(out, glb_version);
  append_little_endian(out, total);
  const auto begin_chunk = [&](uint64_t bytes, uint32_t type) {
    append_little_endian(out, padded(bytes));
    append_little_endian(out, type);
  };
  begin_chunk(json.size(), json_chunk);
  out += json;
  append_padding(out, json.size(), ' ');
  if (binary) {
    begin_chunk(binary_bytes, binary_chunk);
    uint64_t freed = 0;
    for (Piece& piece : *binary) {
      out += piece.bytes();
      freed += std::exchange(piece.owned, std::string()).size();
      if (freed < freed_at_once || spare_bytes() >= freed_at_once) continue;  // skipped while as many bytes are spare
      give_back_freed();
      freed = 0;
    }
    append_padding(out, binary_bytes, '\0');
  }
  for (const ExtraChunk& chunk : extra) {
    begin_chunk(chunk.bytes.size(), chunk.type);
    out += chunk.bytes;
    append_padding(out, chunk.bytes.size(), '\0');
  }
  return out;
}

}  // namespace papilio::proto::gltf
