#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilio::client {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// A number of each element, or a list of numbers if it has a type for their count.
struct PlyProperty {
  std::string_view name;
  PlyType type;
  std::optional<PlyType> count_type;
};

struct PlyElement {
  std::string_view name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Where the property is among this element's, by the first of `names` that there is; nothing if there is
  /// none.
  [[nodiscard]] std::optional<size_t> find(std::initializer_list<std::string_view> names) const;
};

/// What a PLY file says of itself. Names point into the file's bytes.
struct PlyHeader {
  std::optional<std::endian> order;  ///< of a binary file; nothing for text
  std::vector<PlyElement> elements;
  size_t bytes = 0;  ///< length of the header: the data begin there
  size_t lines = 0;  ///< the same in lines
};

/// Throws `ParseError`.
[[nodiscard]] PlyHeader parse_ply_header(std::string_view bytes);

/// Bytes of a number of this type in a binary file.
[[nodiscard]] size_t size_of(PlyType type);

}  // namespace papilio::client
