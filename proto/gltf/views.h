#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "proto/gltf/document.h"

namespace papilio::proto::gltf {

/// Uncompressed bytes of a view in its buffer.
struct ViewRange {
  uint32_t buffer = 0;
  uint64_t offset = 0, length = 0;
};

/// Returns the declared range of a view, which must be within the declared length of its buffer. `where` names the
/// referring object. Throws `Problem` mesh_not_gltf.
[[nodiscard]] ViewRange view_range(const Document& document, uint64_t view, const std::string& where);

/// Throws `Problem` mesh_not_gltf unless all views, and their compressed ranges, lie in their buffers.
void require_sound_views(const Document& document);

/// Bytes of a document's views, decompressed on first use. The document must outlive this. Not thread-safe.
class Views {
 public:
  explicit Views(const Document& document) : document_(document) {}

  [[nodiscard]] const Document& document() const { return document_; }
  /// Returns the uncompressed bytes of a view. Throws `Problem`.
  [[nodiscard]] std::string_view bytes(uint64_t view, const std::string& where);
  /// Counts `more` decoded bytes. Throws `Problem` mesh_too_large beyond `most_decoded_bytes`.
  void require_room(uint64_t more);

 private:
  const Document& document_;
  std::map<uint64_t, std::string> decoded_;  ///< decompressed bytes of compressed views
  uint64_t decoded_bytes_ = 0;
};

/// Upper bound of the bytes of decoded geometry of one scene.
inline constexpr uint64_t most_decoded_bytes = uint64_t{2} << 30;

}  // namespace papilio::proto::gltf
