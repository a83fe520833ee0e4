#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "proto/gltf/document.h"

namespace papilio::proto::gltf {

/// Bytes that a view has in its buffer, uncompressed.
struct ViewRange {
  uint32_t buffer = 0;
  uint64_t offset = 0, length = 0;
};

/// Returns the declared range of a view, within the declared length of its buffer. `where` names what refers to the
/// view. Throws `Problem` mesh_not_gltf.
[[nodiscard]] ViewRange view_range(const Document& document, uint64_t view, const std::string& where);

/// Checks that all views, and what they are decompressed from, lie in their buffers. Throws `Problem` mesh_not_gltf.
void require_sound_views(const Document& document);

/// Bytes of a document's views, decompressed on first use. The document must outlive it. Not thread-safe.
class Views {
 public:
  explicit Views(const Document& document) : document_(document) {}

  [[nodiscard]] const Document& document() const { return document_; }
  /// Returns the uncompressed bytes of a view. Throws `Problem`.
  [[nodiscard]] std::string_view bytes(uint64_t view, const std::string& where);
  /// Throws `Problem` mesh_too_large if `more` decoded bytes exceed what a scene may have; else counts them.
  void require_room(uint64_t more);

 private:
  const Document& document_;
  std::map<uint64_t, std::string> decoded_;  ///< of compressed views
  uint64_t decoded_bytes_ = 0;
};

/// Most bytes of decoded geometry of one scene.
inline constexpr uint64_t most_decoded_bytes = uint64_t{2} << 30;

}  // namespace papilio::proto::gltf
