#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/gltf/encoded_geometry.h"
#include "proto/gltf/references.h"

namespace papilio::proto::gltf {

/// Use of new elements.
enum class Use { vertices, indices };

/// Accessors and views of a document for new contents. Released ones are reused; more are appended if necessary.
class Slots {
 public:
  Slots(Document& document, Released released);

  /// Puts elements in their old accessor, if it is released and not yet reused; else appends an accessor like it.
  /// Returns the accessor.
  uint32_t put(EncodedElements elements, Use use);
  /// Describes elements of a Draco stream: as put(), but the accessor has no view.
  uint32_t describe(const ElementSummary& elements) { return take_accessor(elements); }
  /// Puts a Draco stream in the view `old`, if it is released. Returns its view.
  uint32_t put_stream(std::optional<uint32_t> old, std::string stream);

  /// Decompresses the views that are not replaced.
  void decompress_rest();
  /// Writes the contents. Call once, last.
  [[nodiscard]] BufferPieces finish();

 private:
  uint32_t take_accessor(const ElementSummary& elements);
  uint32_t take_view(std::optional<uint32_t> preferred, Use use);
  /// Removes the elements of released accessors from views that others need.
  void compact_shared_views();

  Document& document_;
  Json& json_;
  std::vector<std::string> added_;  ///< lists that the document did not have
  Released released_;
  Json old_accessors_;                  ///< accessors before the replacement
  std::vector<bool> accessor_is_used_;  ///< released accessors that are reused
  std::vector<bool> view_is_used_;
  std::vector<ViewContent> contents_;
};

}  // namespace papilio::proto::gltf
