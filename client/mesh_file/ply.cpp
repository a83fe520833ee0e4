// Stanford's Polygon File Format: a header of declarations, then data in text or binary. Reads the vertices' x, y, z
// and attributes, and the faces' vertex_indices, of any type; skips everything else.

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/mesh_file/binary.h"
#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/ply_attributes.h"
#include "client/mesh_file/ply_header.h"
#include "client/mesh_file/polygon.h"
#include "client/mesh_file/text_scanner.h"

namespace papilio::client {
namespace {

/// Reader of the numbers after the header. A double represents the values of every type.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, const PlyHeader& header)
      : order_(header.order), binary_(bytes.substr(header.bytes)), text_(binary_, {}, header.lines + 1) {}

  [[nodiscard]] double next(PlyType type) { return order_ ? next_binary(type) : next_text(type); }

  /// Throws unless the file is large enough for the declared elements, so that memory is bounded by the file's size.
  void require(const PlyElement& element) const {
    uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += order_ ? size_of(property.count_type.value_or(property.type)) : sizeof "0";
    // The last number of a text may end without a blank.
    const uint64_t available = order_ ? binary_.size() : text_.remaining() + 1;
    if (least > 0 && element.count > available / least)
      throw ParseError(std::to_string(element.count) + " elements '" + std::string(element.name) +
                       "' are declared, more than the file can hold: it is damaged or cut short");
  }

  /// Throws unless only blanks are left.
  void require_end() {
    if (order_) text_ = TextScanner(binary_, {});
    if (text_.to_word()) throw ParseError("goes on after what its header declares");
  }

 private:
  double next_binary(PlyType type) {
    if (binary_.size() < size_of(type)) throw ParseError("is cut short: it ends within its data");
    const double value = load_as(type);
    binary_.remove_prefix(size_of(type));
    return value;
  }

  [[nodiscard]] double load_as(PlyType type) const {
    switch (type) {
      case PlyType::int8:
        return load<int8_t>(binary_, *order_);
      case PlyType::uint8:
        return load<uint8_t>(binary_, *order_);
      case PlyType::int16:
        return load<int16_t>(binary_, *order_);
      case PlyType::uint16:
        return load<uint16_t>(binary_, *order_);
      case PlyType::int32:
        return load<int32_t>(binary_, *order_);
      case PlyType::uint32:
        return load<uint32_t>(binary_, *order_);
      case PlyType::float32:
        return load<float>(binary_, *order_);
      case PlyType::float64:
        break;
    }
    return load<double>(binary_, *order_);
  }

  double next_text(PlyType type) {
    const std::string_view word = text_.word_anywhere();
    double value = 0;
    float single = 0;
    // A float is rounded once, from its digits.
    const bool is_number = type == PlyType::float32 ? parse_number(word, single) : parse_number(word, value);
    if (!is_number) text_.fail("expected a number, found " + (word.empty() ? "the end of the file" : quoted(word)));
    return type == PlyType::float32 ? single : value;
  }

  std::optional<std::endian> order_;
  std::string_view binary_;
  TextScanner text_;
};

float to_coordinate(double value) {
  if (std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max())
    throw ParseError("has a coordinate too large for a float");
  return static_cast<float>(value);
}

/// Converts a number that must be whole, such as an index or a count.
uint32_t to_index(double value) {
  if (!(value >= 0 && value <= std::numeric_limits<uint32_t>::max()) || value != std::floor(value))
    throw ParseError("has an index or a count that is negative, too large or not whole");
  return static_cast<uint32_t>(value);
}

/// Reads the numbers of one property: one, or those of a list.
void read_property(PlyNumbers& numbers, const PlyProperty& property, std::vector<double>& values) {
  values.clear();
  uint32_t count = property.count_type ? to_index(numbers.next(*property.count_type)) : 1;
  for (; count > 0; --count) values.push_back(numbers.next(property.type));
}

void skip_element(PlyNumbers& numbers, const PlyElement& element) {
  if (element.properties.empty()) return;
  std::vector<double> values;
  for (uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties) read_property(numbers, property, values);
}

void read_vertices(PlyNumbers& numbers, const PlyElement& element, proto::FormattedMesh& mesh) {
  const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
  if (!x || !y || !z) throw ParseError("has vertices without x, y and z");
  std::vector<double> values;
  std::vector<double> firsts(element.properties.size());
  PlyAttributes attributes(element);
  mesh.positions.reserve(element.count);
  for (uint64_t i = 0; i < element.count; ++i) {
    for (size_t k = 0; k < element.properties.size(); ++k) {
      read_property(numbers, element.properties[k], values);
      firsts[k] = values.empty() ? 0 : values[0];
    }
    mesh.positions.push_back({to_coordinate(firsts[*x]), to_coordinate(firsts[*y]), to_coordinate(firsts[*z])});
    attributes.add(firsts);
  }
  attributes.move_to(mesh);
}

void read_faces(PlyNumbers& numbers, const PlyElement& element, PolygonList& faces) {
  const auto indices = element.find({"vertex_indices", "vertex_index"});
  if (!indices) throw ParseError("has faces without vertex_indices");
  std::vector<double> values;
  std::vector<uint32_t> corners;
  for (uint64_t i = 0; i < element.count; ++i) {
    for (size_t k = 0; k < element.properties.size(); ++k) {
      read_property(numbers, element.properties[k], values);
      if (k != *indices) continue;
      corners.clear();
      std::ranges::transform(values, std::back_inserter(corners), to_index);
      faces.add(corners);
    }
  }
}

}  // namespace

proto::FormattedMesh parse_ply(std::string_view bytes) {
  bytes = skip_byte_order_mark(bytes);
  const PlyHeader header = parse_ply_header(bytes);
  PlyNumbers numbers(bytes, header);
  proto::FormattedMesh mesh;
  PolygonList faces;
  for (const PlyElement& element : header.elements) {
    numbers.require(element);
    if (element.name == "vertex") {
      if (!mesh.positions.empty()) throw ParseError("has vertices twice");
      read_vertices(numbers, element, mesh);
    } else if (element.name == "face") {
      read_faces(numbers, element, faces);
    } else if (element.name == "tristrips") {
      throw ParseError("has triangle strips, which are not read: export it with faces");
    } else {
      skip_element(numbers, element);
    }
  }
  numbers.require_end();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.triangles = faces.triangles([&](uint32_t vertex) {
    return vertex < mesh.positions.size() ? mesh.positions[vertex] : Vec3f{nan, nan, nan};
  });
  return mesh;
}

std::string format_ply(const TriangleMesh& mesh, const proto::MeshFormat& format) {
  const PlyAttributeWriter attributes(mesh, format);
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment written by papilio\nelement vertex " +
                      std::to_string(mesh.positions.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\n" + attributes.properties() +
                      "element face " + std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 12 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (size_t p = 0; p < mesh.positions.size(); ++p) {
    store_vector(bytes, mesh.positions[p]);
    attributes.append_values(bytes, p);
  }
  for (const Triangle& triangle : mesh.triangles) {
    store(bytes, uint8_t{3});
    for (const uint32_t vertex : triangle) store(bytes, vertex);
  }
  return bytes;
}

}  // namespace papilio::client
