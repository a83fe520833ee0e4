#include "proto/draco_header.h"

#include <string>

#include "proto/problem.h"

namespace papilio::proto {
namespace {

constexpr int deepest_metadata = 64;

/// Reader of little-endian values. Throws `Problem` at the end of the stream.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  uint8_t byte() { return static_cast<uint8_t>(take(1).front()); }

  uint16_t word() {
    const uint8_t low = byte();
    return static_cast<uint16_t>(low | byte() << 8U);
  }

  /// Reads an unsigned LEB128.
  uint32_t varint() {
    uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const uint8_t b = byte();
      value |= uint64_t{b & 0x7FU} << shift;
      if ((b & 0x80U) == 0) {
        if (value > UINT32_MAX) break;
        return static_cast<uint32_t>(value);
      }
    }
    throw Problem(Code::mesh_not_draco, "A count in the Draco header exceeds 4294967295. Encode the mesh again.");
  }

  std::string_view take(size_t size) {
    if (size > bytes_.size())
      throw Problem(Code::mesh_not_draco, "The Draco stream ends inside its header. Provide the whole file.");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  [[nodiscard]] size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

void skip_metadata_block(Cursor& cursor, int depth) {
  if (depth > deepest_metadata)
    throw Problem(Code::mesh_unsupported, "The Draco metadata is nested deeper than " +
                                              std::to_string(deepest_metadata) +
                                              " levels. Encode the mesh without metadata.");
  for (uint32_t entries = cursor.varint(); entries > 0; --entries) {
    cursor.take(cursor.byte());
    cursor.take(cursor.varint());
  }
  for (uint32_t blocks = cursor.varint(); blocks > 0; --blocks) {
    cursor.take(cursor.byte());
    skip_metadata_block(cursor, depth + 1);
  }
}

void skip_metadata(Cursor& cursor) {
  for (uint32_t attributes = cursor.varint(); attributes > 0; --attributes) {
    cursor.varint();
    skip_metadata_block(cursor, 0);
  }
  skip_metadata_block(cursor, 0);
}

}  // namespace

void require_within(uint64_t count, uint64_t limit, const char* what, const char* advice) {
  if (count > limit)
    throw Problem(Code::mesh_too_large, "The mesh has " + std::to_string(count) + " " + what + "; the limit is " +
                                            std::to_string(limit) + ". " + advice);
}

DracoHeader read_draco_header(std::string_view bytes, const Limits& limits) {
  if (!bytes.starts_with("DRACO"))
    throw Problem(Code::mesh_not_draco,
                  bytes.empty() ? "The mesh is empty (0 bytes). Provide a Draco file."
                                : "The mesh is not a Draco file: it does not start with DRACO. Encode it with "
                                  "draco_encoder or `papilio convert in.obj out.drc`.");
  Cursor cursor(bytes);
  cursor.take(5);
  const unsigned major = cursor.byte();
  const unsigned minor = cursor.byte();
  const unsigned geometry = cursor.byte();
  const unsigned method = cursor.byte();
  const unsigned flags = cursor.word();
  if (major != 2 || minor != 2)
    throw Problem(Code::mesh_unsupported, "The Draco bitstream is version " + std::to_string(major) + "." +
                                              std::to_string(minor) +
                                              "; only 2.2 is supported. Encode the mesh with Draco 1.3 or later.");
  if (geometry != 1)
    throw Problem(Code::mesh_unsupported, "The Draco stream is a point cloud. Provide a triangle mesh.");
  if (method > 1)
    throw Problem(Code::mesh_not_draco, "The Draco stream has encoding method " + std::to_string(method) +
                                            "; only 0 and 1 exist. Encode the mesh again.");
  constexpr unsigned metadata_flag = 0x8000;
  if ((flags & metadata_flag) != 0) skip_metadata(cursor);

  DracoHeader header;
  header.edgebreaker = method == 1;
  header.connectivity = bytes.size() - cursor.left();
  if (header.edgebreaker) {
    cursor.byte();  // traversal
    header.vertices = cursor.varint();
    header.faces = cursor.varint();
  } else {
    header.faces = cursor.varint();
    header.vertices = cursor.varint();
  }
  require_within(header.faces, limits.max_input_faces, "faces");
  require_within(header.vertices, limits.max_input_vertices, "vertices");
  return header;
}

}  // namespace papilio::proto
