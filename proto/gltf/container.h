#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilio::proto::gltf {

/// Chunk of a .glb file of a type that the specification does not define. It is kept unchanged.
struct ExtraChunk {
  uint32_t type = 0;
  std::string_view bytes;
};

/// Bytes to be copied to the output, owned or borrowed.
struct Piece {
  std::string_view borrowed;
  std::string owned{};
  [[nodiscard]] std::string_view bytes() const { return owned.empty() ? borrowed : std::string_view(owned); }
};

/// Chunks of a .glb file, as views of its bytes.
struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
  std::vector<ExtraChunk> extra;
};

/// Acceptance of a .glb file without its end.
enum class Cut { refused, in_binary_chunk };

/// Returns whether the bytes begin like a .glb file.
[[nodiscard]] bool is_glb(std::string_view bytes);

/// Splits a .glb file of version 2 into its chunks. Every length must match the bytes. Source: glTF 2.0, section 4.4.
/// With `Cut::in_binary_chunk` the file may end inside its binary chunk, whose view is then shorter. Throws `Problem`:
/// mesh_not_gltf (damaged, truncated), mesh_unsupported (another version).
[[nodiscard]] Container read_glb(std::string_view bytes, Cut cut = Cut::refused);

/// Writes a .glb file: its JSON padded with spaces, the binary chunk padded with zeros. `binary`: pieces of the chunk,
/// each released once it is copied; nothing for a file without the chunk. Throws `Problem` result_too_large beyond 4
/// GiB, the format's limit.
[[nodiscard]] std::string write_glb(std::string_view json, std::optional<std::vector<Piece>> binary,
                                    const std::vector<ExtraChunk>& extra);

}  // namespace papilio::proto::gltf
