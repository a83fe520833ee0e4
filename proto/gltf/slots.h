#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/gltf/encoded_geometry.h"
#include "proto/gltf/references.h"

namespace papilio::proto::gltf {

/// What new elements are for.
enum class Use { vertices, indices };

/// Places of new contents among the accessors and views of a document. Each released one is used again; more are
/// appended where they do not suffice.
class Slots {
 public:
  Slots(Document& document, Released released);

  /// Puts elements in place of those of their old accessor, if it is released and not yet used again; else appends an
  /// accessor like it. Returns the accessor.
  uint32_t put(EncodedElements elements, Use use);
  /// Describes elements that a Draco stream holds: as `put`, but the accessor has no view.
  uint32_t describe(const ElementSummary& elements) { return take_accessor(elements); }
  /// Puts a Draco stream in place of that of the view `old`. Returns its view.
  uint32_t put_stream(std::optional<uint32_t> old, std::string stream);

  /// Decompresses the views that are not replaced.
  void decompress_rest();
  /// Writes the contents. Call once, last.
  [[nodiscard]] BufferPieces finish();

 private:
  uint32_t take_accessor(const ElementSummary& elements);
  uint32_t take_view(std::optional<uint32_t> preferred, Use use);
  /// Removes what released accessors had in a view that others need.
  void compact_shared_views();

  Document& document_;
  Json& json_;
  std::vector<std::string> added_;  ///< lists that the document did not have
  Released released_;
  Json old_accessors_;                  ///< as they were
  std::vector<bool> accessor_is_used_;  ///< released ones that are used again
  std::vector<bool> view_is_used_;
  std::vector<ViewContent> contents_;
};

}  // namespace papilio::proto::gltf
