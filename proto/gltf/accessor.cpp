#include "proto/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "proto/draco_header.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF stores numbers in little-endian order");

/// Rows and columns of an element type.
struct Shape {
  std::string_view name;
  uint32_t rows, columns;
};
constexpr std::array shapes{Shape{"SCALAR", 1, 1}, Shape{"VEC2", 2, 1}, Shape{"VEC3", 3, 1}, Shape{"VEC4", 4, 1},
                            Shape{"MAT2", 2, 2},   Shape{"MAT3", 3, 3}, Shape{"MAT4", 4, 4}};
constexpr uint32_t column_alignment = 4;

/// Calls `visit` with a zero of the C++ type.
template <class Visit>
auto with_component(ComponentType type, const Visit& visit) {
  switch (type) {
    case ComponentType::int8:
      return visit(int8_t{});
    case ComponentType::uint8:
      return visit(uint8_t{});
    case ComponentType::int16:
      return visit(int16_t{});
    case ComponentType::uint16:
      return visit(uint16_t{});
    case ComponentType::uint32:
      return visit(uint32_t{});
    case ComponentType::float32:
      break;
  }
  return visit(float{});
}

ComponentType component_type(uint64_t number, const std::string& where) {
  if ((number >= 5120 && number <= 5123) || number == 5125 || number == 5126) return static_cast<ComponentType>(number);
  refuse_document(where, "has the unknown componentType " + std::to_string(number));
}

/// Elements in a view.
struct Source {
  std::string_view bytes;
  uint64_t stride;
};

Source source_of(Views& views, const Json& of, uint64_t view, uint64_t count, uint32_t element_bytes, bool may_stride,
                 const std::string& where) {
  const std::string_view bytes = views.bytes(view, where);
  const uint64_t offset = whole_number(of, "byteOffset", where, 0);
  uint64_t stride = element_bytes;
  if (may_stride)
    stride = whole_number(element_of(views.document().json, "bufferViews", view, where), "byteStride",
                          place("bufferViews", view), element_bytes);
  constexpr uint64_t largest_stride = 252;
  if (stride != element_bytes && stride > largest_stride)
    refuse_document(place("bufferViews", view),
                    "has the byteStride " + std::to_string(stride) + "; at most 252 is allowed");
  if (stride == 0) refuse_document(place("bufferViews", view), "has a byteStride of 0");
  const bool is_inside = count == 0 || (offset <= bytes.size() && bytes.size() - offset >= element_bytes &&
                                        (count - 1) <= (bytes.size() - offset - element_bytes) / stride);
  if (!is_inside)
    refuse_document(where, "has " + std::to_string(count) + " elements from byte " + std::to_string(offset) + " of " +
                               place("bufferViews", view) + ", which has " + std::to_string(bytes.size()) + " bytes");
  return {bytes.substr(std::min<uint64_t>(offset, bytes.size())), stride};
}

void copy_elements(const Source& source, Elements& out) {
  const uint32_t size = out.format.bytes();
  if (source.stride == size) {
    std::copy_n(source.bytes.begin(), out.count * size, out.bytes.begin());
    return;
  }
  for (uint64_t i = 0; i < out.count; ++i)
    std::memcpy(&out.bytes[i * size], source.bytes.data() + i * source.stride, size);
}

const Json& object_member(const Json& of, const char* key, const std::string& where) {
  const Json* found = find_member(of, key, where);
  if (found == nullptr) refuse_document(where, "has no " + std::string(key));
  return *found;
}

uint32_t view_member(const Json& of, const std::string& where) {
  const auto view = index_member(of, "bufferView", where);
  if (!view) refuse_document(where, "has no bufferView");
  return *view;
}

/// Replaces the elements of a sparse accessor's indices.
void apply_sparse(Views& views, const Json& sparse, Elements& out, const std::string& where) {
  const uint64_t count = whole_number(sparse, "count", where);
  if (count > out.count)
    refuse_document(where, "replaces " + std::to_string(count) + " of " + std::to_string(out.count) + " elements");
  const Json& indices = object_member(sparse, "indices", where);
  const Json& values = object_member(sparse, "values", where);
  const std::string indices_name = where + ".indices";
  Elements index{
      .format = {component_type(whole_number(indices, "componentType", indices_name), indices_name), 1, false},
      .count = count};
  if (is_signed(index.format.type)) refuse_document(indices_name, "has a componentType that is not unsigned");
  const Source index_source =
      source_of(views, indices, view_member(indices, indices_name), count, index.format.bytes(), false, indices_name);
  index.bytes.resize(count * index.format.bytes());
  copy_elements(index_source, index);
  const std::string values_name = where + ".values";
  const Source value_source =
      source_of(views, values, view_member(values, values_name), count, out.format.bytes(), false, values_name);
  for (uint64_t i = 0; i < count; ++i) {
    const auto at = static_cast<uint64_t>(index.number(i, 0));
    if (at >= out.count)
      refuse_document(indices_name,
                      "has the index " + std::to_string(at) + " of " + std::to_string(out.count) + " elements");
    std::memcpy(&out.bytes[at * out.format.bytes()], value_source.bytes.data() + i * value_source.stride,
                out.format.bytes());
  }
}

}  // namespace

uint32_t bytes_of(ComponentType type) {
  return with_component(type, [](auto zero) { return static_cast<uint32_t>(sizeof zero); });
}

bool is_signed(ComponentType type) {
  return type == ComponentType::int8 || type == ComponentType::int16 || type == ComponentType::float32;
}

double lowest_number(ComponentType type) {
  return with_component(type,
                        [](auto zero) { return static_cast<double>(std::numeric_limits<decltype(zero)>::lowest()); });
}

double highest_number(ComponentType type) {
  return with_component(type,
                        [](auto zero) { return static_cast<double>(std::numeric_limits<decltype(zero)>::max()); });
}

double Elements::number(uint64_t element, uint32_t component) const {
  const char* at = bytes.data() + element * format.bytes() + component * size_t{bytes_of(format.type)};
  return with_component(format.type, [&](auto value) {
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  });
}

void Elements::set_number(uint64_t element, uint32_t component, double number) {
  char* at = bytes.data() + element * format.bytes() + component * size_t{bytes_of(format.type)};
  if (format.type != ComponentType::float32)
    number = std::clamp(std::floor(number + 0.5), lowest_number(format.type), highest_number(format.type));
  with_component(format.type, [&](auto value) {
    value = static_cast<decltype(value)>(number);
    std::memcpy(at, &value, sizeof value);
  });
}

ElementFormat element_format(const Json& accessor, const std::string& where) {
  ElementFormat format{.type = component_type(whole_number(accessor, "componentType", where), where),
                       .normalized = flag_member(accessor, "normalized", where)};
  if (format.type == ComponentType::float32 || format.type == ComponentType::uint32) format.normalized = false;
  const std::string name = text_member(accessor, "type", where);
  const auto* shape = std::ranges::find(shapes, name, &Shape::name);
  if (shape == shapes.end()) refuse_document(where, "has the unknown type " + quote(name));
  uint32_t rows = shape->rows;
  const uint32_t size = bytes_of(format.type);
  if (shape->columns > 1) rows = (rows * size + column_alignment - 1) / column_alignment * column_alignment / size;
  format.components = rows * shape->columns;
  return format;
}

Elements zero_elements(const ElementFormat& format, uint64_t count) {
  return {format, count, std::string(count * format.bytes(), '\0')};
}

Elements read_accessor(Views& views, uint64_t accessor, uint64_t limit, const std::string& where) {
  const Json& json = element_of(views.document().json, "accessors", accessor, where);
  const std::string name = place("accessors", accessor);
  const ElementFormat format = element_format(json, name);
  const uint64_t count = whole_number(json, "count", name);
  require_within(count, limit, "elements in an accessor");
  const auto view = index_member(json, "bufferView", name);
  Source source{{}, 0};
  if (view) source = source_of(views, json, *view, count, format.bytes(), true, name);
  views.require_room(count * format.bytes());
  Elements out = zero_elements(format, count);
  if (view) copy_elements(source, out);
  if (const Json* sparse = find_member(json, "sparse", name)) apply_sparse(views, *sparse, out, name + ".sparse");
  return out;
}

}  // namespace papilio::proto::gltf
