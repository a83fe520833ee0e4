#include <algorithm>
#include <iostream>

#include "client/cli/commands.h"
#include "client/cli/interruption.h"
#include "client/lib/file_words.h"
#include "client/lib/read_materials.h"
#include "proto/detail/decode_packed.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/plain_draco.h"
#include "proto/draco_writer.h"
#include "proto/gltf/material_attribute.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using proto::detail::PackedModel;

void save_triangles(const MeshPlace& output, const proto::gltf::MaterialMesh& model) {
  if (output_format(output) == Format::drc)
    return save_bytes(output, proto::write_draco_exact(model.mesh, model.mesh.format));
  save_mesh(output, model);
}

/// Returns the materials of a decoded scene's triangles, if the output can store any. A cut file lacks them, as they
/// follow the levels.
proto::gltf::Materials material_of(const UnpackFlags& flags, const MeshBytes& file, const TriangleMesh& mesh) {
  if (!holds_materials(flags.output)) return {};
  try {
    return material_of_packed(file.bytes, mesh.triangles.size());
  } catch (const proto::Problem&) {
    if (!flags.may_be_cut) throw;
    return {};
  }
}

/// Returns the style of the written normals, given the original's style.
NormalStyle output_normals(const UnpackFlags& flags, NormalStyle original) {
  const Format format = output_format(flags.output);
  if (!holds_normals(format) || !flags.normals.value_or(true)) return NormalStyle::absent;
  const bool is_asked = flags.normals.has_value();
  if (original == NormalStyle::faceted) return is_asked ? NormalStyle::creased : original;
  // Viewers show scenes without normals faceted, and other meshes smooth.
  if (original == NormalStyle::absent && (is_asked || is_scene(format))) return NormalStyle::creased;
  return original;
}

/// Adds normals to the mesh of a file without levels, unless it has its own. Drops degenerate faces.
void add_output_normals(const UnpackFlags& flags, NormalStyle original, proto::gltf::MaterialMesh& model) {
  const bool has_own =
      std::ranges::count(model.mesh.format.attributes, proto::AttributeKind::normal, &proto::AttributeFormat::kind) > 0;
  if (has_own && holds_normals(output_format(flags.output)) && flags.normals.value_or(true)) return;
  const bool has_materials = !model.materials.empty();
  if (has_materials) proto::gltf::add_material_attribute(model);
  const NormalStyle style = output_normals(flags, original);
  model.mesh = original == NormalStyle::absent && style != NormalStyle::absent
                   ? proto::detail::with_normals_of_shape(std::move(model.mesh))
                   : proto::detail::with_normals(std::move(model.mesh), style);
  if (has_materials)
    model.materials.of_triangle = proto::gltf::take_material_attribute(model.mesh, model.materials.materials.size());
}

std::ostream& begin_report(const UnpackFlags& flags, const TriangleMesh& mesh) {
  std::ostream& out = flags.output.is_standard() ? std::cerr : std::cout;
  return out << proto::escape_controls(flags.output.path.string()) << ": " << mesh.positions.size() << " vertices, "
             << mesh.triangles.size() << " faces, ";
}

size_t whole_levels(const PackedModel& model) {
  return static_cast<size_t>(std::ranges::count(model.levels, 0U, &proto::detail::PackedLevel::missing_pieces));
}

/// Describes the complete part of a cut file.
std::string what_is_there(const PackedModel& model) {
  std::string there =
      std::to_string(whole_levels(model)) + " of " + std::to_string(model.declared_levels) + " levels are whole";
  if (model.levels.empty() || model.levels.back().missing_pieces == 0) return there;
  const proto::detail::PackedLevel& last = model.levels.back();
  const size_t pieces = last.stream.pieces.size();
  return there + ", and of the next one " + std::to_string(pieces - last.missing_pieces) + " of " +
         std::to_string(pieces) + " pieces; the distance is that without these";
}

void report(const UnpackFlags& flags, const PackedModel& model, const TriangleMesh& mesh) {
  const DetailReach reach = reach_of(model);
  begin_report(flags, mesh) << whole_levels(model) << " of " << model.declared_levels
                            << " levels; distance to the original: RMS " << proto::format_rounded(100 * reach.rms)
                            << " % of the diagonal, largest " << proto::format_rounded(100 * reach.largest) << " %\n";
}

/// Decodes a file without levels, which `pack` writes if it is smaller. Returns whether the file is one.
bool unpack_plain(const UnpackFlags& flags, const MeshBytes& file) {
  if (!is_scene(file.format)) return false;
  const auto model =
      in_words_of_the_file(file.name, [&] { return proto::detail::read_plain_draco(file.bytes, own_limits); });
  if (!model) return false;
  if (flags.levels.value_or(0) > 0) print_warnings({file.name + " is plain Draco and has no levels."});
  proto::gltf::MaterialMesh decoded;
  in_words_of_the_file(file.name, [&] {
    decoded.mesh = model->mesh;
    decoded.materials = material_of(flags, file, decoded.mesh);
    add_output_normals(flags, model->normals, decoded);
  });
  save_triangles(flags.output, decoded);
  begin_report(flags, decoded.mesh) << "plain Draco without levels\n";
  return true;
}

}  // namespace

void unpack_command(const UnpackFlags& flags) {
  check_output(flags.output);
  const MeshBytes file = read_mesh(flags.input);
  if (!proto::detail::is_packed(file.bytes) && unpack_plain(flags, file)) return;
  const auto levels = static_cast<size_t>(flags.levels.value_or(most_detail_levels));
  const Interruption interruption;
  PackedModel model;
  proto::gltf::MaterialMesh decoded;
  in_words_of_the_file(file.name, [&] {
    model = proto::detail::read_packed(file.bytes,
                                       {.limits = own_limits, .levels = levels, .may_be_cut = flags.may_be_cut});
    decoded.mesh = proto::detail::decode_packed(
        model, {.normals = output_normals(flags, model.normals), .cancelled = [] { return Interruption::is_asked(); }});
    decoded.materials = material_of(flags, file, decoded.mesh);
  });
  if (flags.levels && levels > model.declared_levels)
    print_warnings({file.name + " has " + std::to_string(model.declared_levels) + " levels."});
  else if (whole_levels(model) < std::min(levels, model.declared_levels))
    print_warnings({file.name + " is cut: " + what_is_there(model) + '.'});
  save_triangles(flags.output, decoded);
  report(flags, model, decoded.mesh);
}

}  // namespace papilio::client
