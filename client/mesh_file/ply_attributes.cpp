#include "client/mesh_file/ply_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/mesh_file/binary.h"

namespace papilio::client {
namespace {

using proto::AttributeFormat;
using proto::AttributeKind;
using proto::ValueType;

struct Names {
  AttributeKind kind;
  std::vector<std::string_view> components;
};

const std::vector<Names>& known_names() {
  static const std::vector<Names> names{
      {AttributeKind::normal, {"nx", "ny", "nz"}},      {AttributeKind::color, {"red", "green", "blue", "alpha"}},
      {AttributeKind::color, {"red", "green", "blue"}}, {AttributeKind::tex_coord, {"s", "t"}},
      {AttributeKind::tex_coord, {"u", "v"}},           {AttributeKind::tex_coord, {"texture_u", "texture_v"}},
  };
  return names;
}

bool has_kind(const std::vector<AttributeFormat>& formats, AttributeKind kind) {
  return std::ranges::find(formats, kind, &AttributeFormat::kind) != formats.end();
}

/// Returns whether an attribute is stored in bytes: colours of bytes are, all others are floats.
bool are_bytes(AttributeKind kind, PlyType type) { return kind == AttributeKind::color && type == PlyType::uint8; }

}  // namespace

PlyAttributes::PlyAttributes(const PlyElement& element) {
  for (const Names& names : known_names()) {
    std::vector<size_t> properties;
    for (const std::string_view name : names.components)
      if (const auto found = element.find({name})) properties.push_back(*found);
    if (properties.size() < names.components.size() || has_kind(formats_, names.kind)) continue;
    const bool bytes =
        std::ranges::all_of(properties, [&](size_t p) { return are_bytes(names.kind, element.properties[p].type); });
    attributes_.push_back({static_cast<uint32_t>(properties.size()), names.kind == AttributeKind::normal, {}});
    formats_.push_back({.kind = names.kind,
                        .type = bytes ? ValueType::uint8 : ValueType::float32,
                        .normalized = bytes,
                        .id = static_cast<uint32_t>(formats_.size() + 1)});
    properties_.push_back(std::move(properties));
  }
}

void PlyAttributes::add(std::span<const double> numbers) {
  for (size_t a = 0; a < attributes_.size(); ++a)
    for (const size_t property : properties_[a]) attributes_[a].values.push_back(numbers[property]);
}

void PlyAttributes::move_to(proto::FormattedMesh& mesh) {
  mesh.attributes = std::move(attributes_);
  mesh.format.attributes = std::move(formats_);
}

PlyAttributeWriter::PlyAttributeWriter(const TriangleMesh& mesh, const proto::MeshFormat& format) {
  std::vector<AttributeFormat> done;
  for (size_t a = 0; a < format.attributes.size(); ++a) {
    const AttributeFormat& its = format.attributes[a];
    const auto names = std::ranges::find_if(known_names(), [&](const Names& n) {
      return n.kind == its.kind && n.components.size() == mesh.attributes[a].components;
    });
    if (names == known_names().end() || has_kind(done, its.kind)) continue;
    const bool bytes = its.kind == AttributeKind::color && its.type == ValueType::uint8;
    for (const std::string_view name : names->components)
      properties_ += (bytes ? "property uchar " : "property float ") + std::string(name) + "\n";
    chosen_.push_back({&mesh.attributes[a], bytes, proto::unit_value(its)});
    done.push_back(its);
  }
}

void PlyAttributeWriter::append_values(std::string& bytes, size_t point) const {
  for (const auto& [attribute, as_bytes, one] : chosen_)
    for (size_t i = 0; i < attribute->components; ++i) {
      const double value = attribute->values[point * attribute->components + i];
      if (as_bytes)
        store(bytes, static_cast<uint8_t>(std::clamp(std::round(value), 0.0, 255.0)));
      else
        store(bytes, static_cast<float>(value / one));
    }
}

}  // namespace papilio::client
