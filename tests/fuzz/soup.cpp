#include "tests/fuzz/soup.h"

#include <algorithm>
#include <cmath>

#include "proto/text.h"
#include "tests/fuzz/fuzz.h"

namespace papilio::fuzz {
namespace {

using proto::ParameterInfo;
using proto::ParameterType;

void take_attribute(ByteSource& bytes, proto::FormattedMesh& mesh) {
  proto::AttributeFormat format;
  format.kind = static_cast<proto::AttributeKind>(bytes.up_to(3));
  format.type = static_cast<proto::ValueType>(bytes.up_to(10));
  format.normalized = bytes.flag();
  format.id = 1 + static_cast<uint32_t>(mesh.attributes.size());
  Attribute attribute;
  attribute.components = 1 + bytes.up_to(3);
  attribute.unit_length = format.kind == proto::AttributeKind::normal;
  attribute.values.resize(mesh.positions.size() * attribute.components);
  for (double& value : attribute.values) value = bytes.coordinate();
  mesh.attributes.push_back(std::move(attribute));
  mesh.format.attributes.push_back(std::move(format));
}

/// Returns a value of the row as text. The parser decides whether a view defines a picture.
std::string take_value(ByteSource& bytes, const ParameterInfo& info) {
  if (info.type == ParameterType::boolean) return bytes.flag() ? "true" : "false";
  if (info.type == ParameterType::choice)
    return std::string(info.choices[bytes.up_to(static_cast<uint32_t>(info.choices.size()) - 1)]);
  const size_t groups =
      info.least / info.group +
      (info.most > info.least ? bytes.up_to(static_cast<uint32_t>(info.most - info.least)) : 0) / info.group;
  std::string text;
  for (size_t i = 0; i < std::max<size_t>(1, groups) * info.group; ++i) {
    double value = bytes.between(info.min, info.max);
    if (bytes.up_to(3) == 0) value = std::clamp<double>(bytes.up_to(20) - 10.0, info.min, info.max);
    if (info.type == ParameterType::integer) value = std::round(value);
    proto::append_item(text, ",", proto::format_number(value));
  }
  return text;
}

}  // namespace

proto::FormattedMesh take_soup(ByteSource& bytes) {
  proto::FormattedMesh mesh;
  mesh.positions.resize(3 + bytes.up_to(40));
  mesh.triangles.resize(1 + bytes.up_to(80));
  const auto most = static_cast<uint32_t>(mesh.positions.size()) - (bytes.up_to(31) == 31 ? 0 : 1);
  const uint32_t attributes = bytes.up_to(8);
  for (Triangle& triangle : mesh.triangles)
    for (uint32_t& corner : triangle) corner = bytes.up_to(most);
  for (Vec3f& p : mesh.positions) p = {bytes.coordinate(), bytes.coordinate(), bytes.coordinate()};
  for (uint32_t i = 0; i < attributes && i < 2; ++i) take_attribute(bytes, mesh);
  return mesh;
}

proto::Parameters take_parameters(ByteSource& bytes, int most_levels) {
  proto::QueryFields fields;
  for (const ParameterInfo& info : proto::parameter_table()) {
    if (bytes.up_to(3) != 1) continue;
    const bool is_levels = info.name == "levels";
    fields.emplace_back(info.name, is_levels ? std::to_string(bytes.up_to(static_cast<uint32_t>(most_levels)))
                                             : take_value(bytes, info));
  }
  return proto::parse_query(fields);
}

void require_sound(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  require(topology.origin.size() == topology.half_edge_count() && topology.twin.size() == topology.origin.size() &&
              topology.edge.size() == topology.origin.size() && topology.kind.size() == topology.edge_count() &&
              mesh.positions.size() == topology.vertex_count,
          "arrays have one size");
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    const uint32_t twin = topology.twin[h];
    require(topology.origin[h] < topology.vertex_count, "vertices are in range");
    require(topology.origin[h] != topology.tip(h), "no edge ends where it begins");
    require(topology.edge[h] < topology.edge_count(), "edges are in range");
    require(twin == none || (twin < topology.half_edge_count() && topology.twin[twin] == h &&
                             topology.edge[twin] == topology.edge[h] && topology.origin[twin] == topology.tip(h)),
            "twins are mutual");
  }
  for (uint32_t e = 0; e < topology.edge_count(); ++e)
    require(topology.edge[topology.half_edge[e]] == e, "edges know their half-edges");
  for (const Vec3f& p : mesh.positions)
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite");
  const PointAttributes& points = mesh.attributes;
  if (points.empty()) return;
  require(points.point.size() == topology.origin.size(), "every corner has its point");
  for (const uint32_t point : points.point) require(point < points.point_count, "points are in range");
  for (const Attribute& attribute : points.attributes)
    require(attribute.values.size() == size_t{points.point_count} * attribute.components, "every point has values");
}

}  // namespace papilio::fuzz
