#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "client/cli/commands.h"
#include "client/lib/file_words.h"
#include "papilio/refine.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/findings.h"
#include "proto/gltf/scene_description.h"
#include "proto/refinement.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using nlohmann::ordered_json;

/// Describes the levels of a packed model, or their defect.
ordered_json describe_detail(const MeshBytes& file) {
  try {
    return ordered_json::parse(proto::detail::describe(proto::detail::read_packed(file.bytes, {.limits = own_limits})));
  } catch (const proto::Problem& problem) {
    return {{"fault", problem.what()}};
  }
}

ordered_json describe_scene_file(const MeshBytes& file) {
  ordered_json description{{"file", file.name}, {"bytes", file.bytes.size()}};
  description.update(ordered_json::parse(
      in_words_of_the_file(file.name, [&] { return proto::gltf::describe_scene(file.bytes, own_limits); })));
  if (proto::detail::is_packed(file.bytes)) description["detail"] = describe_detail(file);
  return description;
}

/// Returns the names of attributes, as in descriptions of scenes: in glTF's words, or a generic one's own name.
ordered_json attribute_names(const proto::MeshFormat& format) {
  ordered_json names{"POSITION"};
  int texcoords = 0, colours = 0;
  for (const proto::AttributeFormat& attribute : format.attributes) switch (attribute.kind) {
      case proto::AttributeKind::normal:
        names.push_back("NORMAL");
        break;
      case proto::AttributeKind::tex_coord:
        names.push_back("TEXCOORD_" + std::to_string(texcoords++));
        break;
      case proto::AttributeKind::color:
        names.push_back("COLOR_" + std::to_string(colours++));
        break;
      case proto::AttributeKind::generic:
        names.push_back(attribute.name.empty() ? "generic" : attribute.name);
        break;
    }
  return names;
}

ordered_json describe(const MeshPlace& input) {
  const MeshBytes file = read_mesh(input);
  if (is_scene(file.format)) return describe_scene_file(file);
  BuildReport report;
  ordered_json attributes;
  const Mesh mesh = in_words_of_the_file(file.name, [&] {
    const proto::FormattedMesh triangles = triangles_of(file);
    attributes = attribute_names(triangles.format);
    return build_mesh(triangles, &report, rounding_gap);
  });
  const Topology& topology = mesh.topology;
  const Box box = bounding_box(mesh.positions);
  const auto triple = [](Vec3f p) { return ordered_json{p.x, p.y, p.z}; };
  ordered_json description{
      {"file", file.name},
      {"bytes", file.bytes.size()},
      {"vertices", topology.vertex_count},
      {"faces", topology.face_count()},
      {"edges", topology.edge_count()},
      {"euler_characteristic", topology.euler_characteristic()},
      {"attributes", std::move(attributes)},
      {"closed", report.boundary_edges + report.non_manifold_edges + report.misoriented_edges == 0}};
  const ShapeReport shape = shape_of(mesh);
  description["shape"] = proto::shape_text(shape);
  description["marked_creases"] = shape.marked;
  for (const auto& [name, count] : proto::all_findings(report)) description[std::string(name)] = count;
  description["box"] = {{"min", triple(box.min)}, {"max", triple(box.max)}, {"diagonal", box.diagonal()}};
  return description;
}

void print(const ordered_json& value, const std::string& name) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) print(inner, name.empty() ? key : name + "." + key);
    return;
  }
  const bool is_list = value.is_array() && !value.empty() && value[0].is_object();
  for (size_t i = 0; is_list && i < value.size(); ++i) print(value[i], name + "." + std::to_string(i));
  if (is_list) return;
  std::cout << name << std::string(name.size() < 24 ? 24 - name.size() : 1, ' ')
            << (value.is_string() ? proto::escape_controls(value.get<std::string>()) : value.dump()) << '\n';
}

}  // namespace

void info_command(const InfoFlags& flags) {
  const ordered_json description = describe(flags.input);
  if (flags.json)
    std::cout << description.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  else
    print(description, "");
}

}  // namespace papilio::client
