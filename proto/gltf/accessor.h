#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "proto/gltf/views.h"
#include "proto/limits.h"

namespace papilio::proto::gltf {

/// Stored type of a component, by glTF's number.
enum class ComponentType : uint32_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};
/// Upper bound of the vertices whose indices fit 16 bits: the largest number restarts a primitive.
inline constexpr uint64_t most_vertices_of_16_bits = 65535;

[[nodiscard]] uint32_t bytes_of(ComponentType type);
[[nodiscard]] bool is_signed(ComponentType type);
/// Returns the smallest and the largest number of an integer type.
[[nodiscard]] double lowest_number(ComponentType type);
[[nodiscard]] double highest_number(ComponentType type);

/// Format of an accessor's elements.
struct ElementFormat {
  ComponentType type = ComponentType::float32;
  uint32_t components = 1;  ///< components, including the padding of a matrix's columns
  bool normalized = false;  ///< integers represent the range from 0 (or -1) to 1

  [[nodiscard]] uint32_t bytes() const { return components * bytes_of(type); }
  /// Returns the factor from a stored number to its value.
  [[nodiscard]] double unit() const { return normalized ? 1 / highest_number(type) : 1; }
  friend bool operator==(const ElementFormat&, const ElementFormat&) = default;
};

/// Elements of an accessor, tightly packed.
struct Elements {
  ElementFormat format;
  uint64_t count = 0;
  std::string bytes{};  ///< [count * format.bytes()]

  /// Returns a stored number, not normalized.
  [[nodiscard]] double number(uint64_t element, uint32_t component) const;
  /// Stores a number; integers are rounded and clamped to the range of their type.
  void set_number(uint64_t element, uint32_t component, double number);
  /// Returns the bytes of an element.
  [[nodiscard]] std::string_view element(uint64_t index) const {
    return std::string_view(bytes).substr(index * format.bytes(), format.bytes());
  }
};

/// Returns the declared format of an accessor. Throws `Problem` mesh_not_gltf.
[[nodiscard]] ElementFormat element_format(const Json& accessor, const std::string& where);

/// Decodes an accessor of any type: strided, sparse, or without a view (zeros). `where` names the referring object.
/// Checks `limit`, the upper bound of its elements, before any allocation. Throws `Problem`: mesh_not_gltf,
/// mesh_too_large.
[[nodiscard]] Elements read_accessor(Views& views, uint64_t accessor, uint64_t limit, const std::string& where);

/// Returns elements of zeros.
[[nodiscard]] Elements zero_elements(const ElementFormat& format, uint64_t count);

}  // namespace papilio::proto::gltf
