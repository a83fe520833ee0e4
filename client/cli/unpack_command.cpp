#include <iostream>

#include "client/cli/commands.h"
#include "client/cli/interruption.h"
#include "client/lib/file_words.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/plain_draco.h"
#include "proto/draco_writer.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

using proto::detail::PackedModel;

void save_triangles(const MeshPlace& output, const proto::FormattedMesh& mesh) {
  if (output_format(output) == Format::drc) return save_bytes(output, proto::write_draco_exact(mesh));
  save_mesh(output, {.mesh = mesh});
}

std::ostream& begin_report(const UnpackFlags& flags, const TriangleMesh& mesh) {
  std::ostream& out = flags.output.is_standard() ? std::cerr : std::cout;
  return out << proto::escape_controls(flags.output.path.string()) << ": " << mesh.positions.size() << " vertices, "
             << mesh.triangles.size() << " faces, ";
}

void report(const UnpackFlags& flags, const PackedModel& model, const TriangleMesh& mesh) {
  const DetailReach reach = reach_of(model);
  begin_report(flags, mesh) << model.levels.size() << " of " << model.declared_levels
                            << " levels; distance to the original: RMS " << proto::format_rounded(100 * reach.rms)
                            << " % of the diagonal, largest " << proto::format_rounded(100 * reach.largest) << " %\n";
}

/// Decodes the file without levels that `pack` writes where that is smaller. Returns whether it is one.
bool unpack_plain(const UnpackFlags& flags, const MeshBytes& file) {
  if (!is_scene(file.format)) return false;
  const auto mesh =
      in_words_of_the_file(file.name, [&] { return proto::detail::read_plain_draco(file.bytes, own_limits); });
  if (!mesh) return false;
  if (flags.levels.value_or(0) > 0) print_warnings({file.name + " is plain Draco and has no levels."});
  proto::FormattedMesh formatted;
  static_cast<TriangleMesh&>(formatted) = *mesh;
  save_triangles(flags.output, formatted);
  begin_report(flags, *mesh) << "plain Draco without levels\n";
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
  proto::FormattedMesh mesh;
  in_words_of_the_file(file.name, [&] {
    model = proto::detail::read_packed(file.bytes,
                                       {.limits = own_limits, .levels = levels, .may_be_cut = flags.may_be_cut});
    static_cast<TriangleMesh&>(mesh) =
        decode_detail(model.base, model.streams(), face_count_limit, [] { return Interruption::is_asked(); });
  });
  if (flags.levels && levels > model.declared_levels)
    print_warnings({file.name + " has " + std::to_string(model.declared_levels) + " levels."});
  else if (model.levels.size() < std::min(levels, model.declared_levels))
    print_warnings({file.name + " is cut: " + std::to_string(model.levels.size()) + " of " +
                    std::to_string(model.declared_levels) + " levels are whole."});
  save_triangles(flags.output, mesh);
  report(flags, model, mesh);
}

}  // namespace papilio::client
