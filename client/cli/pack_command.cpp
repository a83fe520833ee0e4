#include <algorithm>
#include <cmath>
#include <iostream>

#include "client/cli/commands.h"
#include "client/cli/interruption.h"
#include "client/cli/progress.h"
#include "client/lib/file_words.h"
#include "client/lib/read_materials.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_normals.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/gltf/document.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using proto::format_rounded;
using proto::detail::Packed;

bool has_morph_targets(const proto::gltf::Json& scene) {
  return std::ranges::any_of(proto::gltf::array_of(scene, "meshes"), [](const auto& mesh) {
    return std::ranges::any_of(proto::gltf::array_of(mesh, "primitives"),
                               [](const auto& primitive) { return primitive.contains("targets"); });
  });
}

/// Warns of data that a packed model does not store.
void warn_of_losses(const MeshBytes& file, const proto::gltf::MaterialMesh& model) {
  std::vector<std::string> warnings;
  const size_t packed = (proto::detail::texcoords_to_pack(model.mesh) ? 1 : 0) +
                        (proto::detail::colours_to_pack(model.mesh) ? 1 : 0) +
                        (proto::detail::normals_to_pack(model.mesh) ? 1 : 0);
  const bool has_groups = std::ranges::any_of(model.mesh.attributes, &Attribute::is_smoothing_group);
  if (has_groups) warnings.push_back(file.name + ": smoothing groups are left out; edges are sharp by their angle.");
  if (model.mesh.attributes.size() > packed + (has_groups ? 1 : 0))
    warnings.push_back(file.name + ": other attributes than texture coordinates, colours and normals are left out.");
  if (proto::detail::has_opacity(model.mesh))
    warnings.push_back(file.name + ": the opacity of its colours is left out.");
  for (const std::string& text : model.materials.left_out) warnings.push_back(file.name + ": " + text);
  if (is_scene(file.format)) {
    const proto::gltf::Json json = proto::gltf::read_document(file.bytes).json;
    const auto warn = [&](const std::string& what) {
      warnings.push_back(file.name + ": the scene's " + what + " left out.");
    };
    for (const char* part : {"skins", "animations"})
      if (json.contains(part)) warn(part + std::string(" are"));
    if (has_morph_targets(json)) warn("morph targets are");
    if (const auto extensions = json.find("extensions"); extensions != json.end())
      for (const auto& [name, data] : extensions->items()) warn(name + " is");
  }
  print_warnings(warnings);
}

std::string reach_text(const DetailReach& reach) {
  return "RMS " + format_rounded(100 * reach.rms) + " %, largest " + format_rounded(100 * reach.largest) + " %";
}

void print_packed(std::ostream& out, const Packed& packed) {
  const proto::detail::PackedModel& model = *packed.model;
  uint64_t bytes = model.base_bytes, texcoord_bytes = 0;
  out << "base      " << model.base.triangles.triangles.size() << " faces, " << bytes
      << " bytes: " << reach_text(model.base_reach) << '\n';
  for (size_t l = 0; l < model.levels.size(); ++l) {
    const auto& level = model.levels[l];
    bytes += level.stream.bytes.size();
    texcoord_bytes += level.stream.texcoords.bytes.size();
    out << "level " << l + 1 << (l < 9 ? "   " : "  ") << level.faces << " faces, " << level.stream.bytes.size()
        << " bytes";
    if (!level.stream.pieces.empty()) out << " in " << level.stream.pieces.size() << " pieces";
    out << ": " << reach_text(level.reach) << '\n';
  }
  const char* const values = !model.has_colours()    ? "texture coordinates"
                             : model.has_texcoords() ? "texture coordinates and colours"
                                                     : "colours";
  if (model.has_texcoords() || model.has_colours()) out << values << " of the levels " << texcoord_bytes << " bytes\n";
  if (packed.image_bytes > 0) out << "images of the materials " << packed.image_bytes << " bytes\n";
  out << "container " << packed.glb.size() - bytes - texcoord_bytes - packed.image_bytes << " bytes\n"
      << "distances are shares of the diagonal; " << packed.folds << " folded faces";
  if (packed.parted > 0) out << "; parted at " << packed.parted << " vertices where the surface touches itself";
  out << '\n';
}

/// Returns whether the file is a simplified mesh.
bool is_simplified(const Packed& packed) {
  return !packed.model && packed.simplified && packed.simplified->bytes == packed.glb.size();
}

void print_report(std::ostream& out, const PackFlags& flags, const Packed& packed) {
  if (flags.json) {
    out << proto::detail::pack_report(packed) << '\n';
    return;
  }
  const std::string grid = std::to_string(packed.plain_bits) + " bits, RMS " + format_rounded(100 * packed.plain_rms) +
                           " %" + (packed.plain_has_normals ? ", with normals" : "");
  if (!packed.model) {
    const auto& simplified = packed.simplified;
    if (is_simplified(packed))
      out << packed.glb.size() << " bytes of Draco, simplified to " << simplified->faces << " faces ("
          << simplified->position_bits << " bits, " << reach_text(simplified->reach) << ")\n";
    else
      out << packed.glb.size() << " bytes of plain Draco (" << grid << ")\n";
    return;
  }
  print_packed(out, packed);
  const std::string ratio =
      format_rounded(static_cast<double>(packed.plain_bytes) / static_cast<double>(packed.glb.size()));
  out << packed.glb.size() << " bytes; plain Draco at the same distance (" << grid << "): " << packed.plain_bytes
      << " bytes, " << (ratio == "1" ? "as many" : ratio + " times as many") << '\n';
  if (packed.simplified)
    out << "simplified to " << packed.simplified->faces << " faces, as Draco: " << packed.simplified->bytes
        << " bytes\n";
}

void check_goals(const PackFlags& flags) {
  if (int{flags.rms.has_value()} + int{flags.largest.has_value()} + int{flags.bytes.has_value()} > 1)
    throw UsageError("--rms, --max and --bytes are goals in place of each other. Give one.");
  if (flags.rms && std::isnan(*flags.rms)) throw UsageError("--rms must be a number from 1e-6 to 0.1.");
  if (flags.largest && std::isnan(*flags.largest)) throw UsageError("--max must be a number from 1e-6 to 1.");
}

void warn_of_result(const Packed& packed) {
  if (!packed.model)
    return print_warnings({(is_simplified(packed) ? "The file is a simplified mesh as Draco, without levels. "
                                                  : "The file is plain Draco without levels. ") +
                           packed.reason});
  const double reached = reach_of(*packed.model).rms;
  if (packed.wanted_rms > 0 && reached > packed.wanted_rms)
    print_warnings({"The RMS distance reached is " + format_rounded(reached) + ", not " +
                    format_rounded(packed.wanted_rms) + "."});
}

}  // namespace

void pack_command(const PackFlags& flags) {
  check_goals(flags);
  MeshPlace output = flags.output;
  if (output.is_standard() && !output.format) output.format = Format::glb;
  check_output(output);
  if (output_format(output) != Format::glb) throw UsageError("A packed model is a .glb file. Name one with -o.");
  const MeshBytes file = read_mesh(flags.input);
  const MaterialRead original = read_with_materials(flags.input, file);
  print_warnings(original.warnings);
  warn_of_losses(file, original.model);
  const Interruption interruption;
  const Packed packed = in_words_of_the_file(file.name, [&] {
    ShareProgress progress;
    return proto::detail::pack(original.model, {.rms = flags.rms.value_or(proto::detail::PackOptions{}.rms),
                                                .largest = flags.largest.value_or(0),
                                                .bytes = static_cast<uint64_t>(flags.bytes.value_or(0)),
                                                .jobs = flags.jobs,
                                                .piece_bytes = flags.piece_bytes,
                                                .simplifies = !flags.no_simplify,
                                                .cancelled = [] { return Interruption::is_asked(); },
                                                .on_progress = [&](double share) { progress.show(share); }});
  });
  save_bytes(output, packed.glb);
  print_report(output.is_standard() ? std::cerr : std::cout, flags, packed);
  warn_of_result(packed);
}

}  // namespace papilio::client
