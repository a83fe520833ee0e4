#include "client/mesh_file/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/text_scanner.h"

namespace papilio::client {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

PlyType parse_type(const TextScanner& scanner, std::string_view word) {
  for (const auto& [name, type] : kTypes)
    if (word == name) return type;
  scanner.fail("expected the type of a number, found " + quoted(word));
}

std::optional<std::endian> parse_order(TextScanner& scanner) {
  const std::string_view format = scanner.word();
  if (format == "ascii") return std::nullopt;
  if (format == "binary_little_endian") return std::endian::little;
  if (format == "binary_big_endian") return std::endian::big;
  scanner.fail("unknown PLY format " + quoted(format));
}

PlyElement parse_element(TextScanner& scanner) {
  PlyElement element{.name = scanner.word(), .count = 0, .properties = {}};
  const int64_t count = scanner.integer();
  if (count < 0) scanner.fail("a count is negative");
  element.count = static_cast<uint64_t>(count);
  return element;
}

PlyProperty parse_property(TextScanner& scanner) {
  PlyProperty property{};
  std::string_view word = scanner.word();
  if (word == "list") {
    property.count_type = parse_type(scanner, scanner.word());
    word = scanner.word();
  }
  property.type = parse_type(scanner, word);
  property.name = scanner.word();
  if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64)
    scanner.fail("the count of a list is not of an integer type");
  return property;
}

}  // namespace

std::optional<size_t> PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view wanted : names) {
    const auto found = std::ranges::find(properties, wanted, &PlyProperty::name);
    if (found != properties.end()) return static_cast<size_t>(found - properties.begin());
  }
  return std::nullopt;
}

PlyHeader parse_ply_header(std::string_view bytes) {
  TextScanner scanner(bytes, {});
  if (scanner.word() != "ply") scanner.fail("expected the keyword ply");
  PlyHeader header;
  bool has_format = false;
  while (scanner.next_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "format") {
      header.order = parse_order(scanner);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(scanner));
    } else if (keyword == "property") {
      if (header.elements.empty()) scanner.fail("a property comes before the first element");
      header.elements.back().properties.push_back(parse_property(scanner));
    } else if (keyword == "end_header") {
      if (!has_format) scanner.fail("the header names no format");
      header.bytes = scanner.end_of_line();
      header.lines = scanner.line();
      return header;
    } else if (keyword != "comment" && keyword != "obj_info") {
      scanner.fail("unknown keyword " + quoted(keyword) + " in the header");
    }
  }
  scanner.fail("the file ends within its header");
}

size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

}  // namespace papilio::client
