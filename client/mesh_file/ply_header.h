#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilio::client {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Property of an element: a number, or a list of numbers if it has a type for their count.
struct PlyProperty {
  std::string_view name;
  PlyType type;
  std::optional<PlyType> count_type;
};

struct PlyElement {
  std::string_view name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Returns the index of the property with the first of `names` that exists; nothing if none does.
  [[nodiscard]] std::optional<size_t> find(std::initializer_list<std::string_view> names) const;
};

/// Header of a PLY file. Names point into the file's bytes.
struct PlyHeader {
  std::optional<std::endian> order;  ///< byte order of a binary file; nothing for text
  std::vector<PlyElement> elements;
  size_t bytes = 0;  ///< length of the header in bytes, the offset of the data
  size_t lines = 0;  ///< length of the header in lines
};

/// Parses a header. Throws `ParseError`.
[[nodiscard]] PlyHeader parse_ply_header(std::string_view bytes);

/// Returns the bytes of a number of a type in a binary file.
[[nodiscard]] size_t size_of(PlyType type);

}  // namespace papilio::client
